// kinebus-papers: the numbers of the machines' papers beside ours, and pictures.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {

Table::Table(const char* title) {
  std::printf("\n%s\n%-58s %14s %14s\n", title, "", "paper", "here");
}

void Table::row(const std::string& what, const std::string& paper, double here, const char* unit, bool good) {
  std::printf("  %-56s %14s %14.6g %-6s%s\n", what.c_str(), paper.c_str(), here, unit,
              good ? "" : "  DIFFERS");
  wrong_ += good ? 0 : 1;
}

void Table::compare(const std::string& what, double paper, double here, double tolerance, const char* unit) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", paper);
  row(what, text, here, unit, std::abs(here - paper) <= tolerance);
}

void Table::below(const std::string& what, double bound, double here, const char* unit) {
  char text[32];
  std::snprintf(text, sizeof text, "<= %.4g", bound);
  row(what, text, here, unit, here <= bound);
}

void Table::above(const std::string& what, double bound, double here, const char* unit) {
  char text[32];
  std::snprintf(text, sizeof text, ">= %.4g", bound);
  row(what, text, here, unit, here >= bound);
}

void Table::note(const std::string& words) {
  std::printf("  %s\n", words.c_str());
}

void write_picture(const std::string& folder, const char* name, const std::string& svg) {
  if (folder.empty()) return;
  std::filesystem::create_directories(folder);
  const auto path = std::filesystem::path(folder) / name;
  std::ofstream out(path, std::ios::binary);
  out << svg;
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
  std::printf("  picture: %s\n", path.c_str());
}

namespace {

int run(const std::string& paper, const std::string& folder) {
  int wrong = 0;
  const bool all = paper == "all";
  if (all || paper == "m1") wrong += m1(folder);
  if (all || paper == "m4") wrong += m4(folder);
  if (all || paper == "m5") wrong += m5(folder);
  std::printf("\n%s\n", wrong == 0 ? "all numbers agree" : "SOME NUMBERS DIFFER");
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace kinebus::papers

int main(int argc, char** argv) {
  try {
    std::string paper = "all", folder;
    CLI::App app("The papers' numbers beside ours");
    app.add_option("paper", paper, "m1, m4, m5 or all (default); M2 and M3: tools/papers")
        ->check(CLI::IsMember({"m1", "m4", "m5", "all"}));
    app.add_option("--pictures", folder, "Write pictures (SVG) into this folder");
    CLI11_PARSE(app, argc, argv);
    return kinebus::papers::run(paper, folder);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "kinebus-papers: %s\n", e.what());
    return 1;
  }
}
