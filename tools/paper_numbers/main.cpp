// kinebus-papers: what the machines' papers print, what follows from them, what comes out here; and pictures.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "gateway/description/shipped_machines.hpp"
#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {

namespace {

std::string words_of(const std::optional<double>& value) {
  return value ? printed("%.6g", *value) : "-";
}

}  // namespace

Table::Table(const char* title) {
  std::printf("\n%s\n%-58s %14s %14s %14s\n", title, "", "paper prints", "follows", "here");
}

void Table::row(const std::string& what, const std::string& prints, const std::string& follows, double here,
                const char* unit, const std::string& remark) {
  std::printf("  %-56s %14s %14s %14.6g %-6s%s\n", what.c_str(), prints.c_str(), follows.c_str(), here, unit,
              remark.c_str());
}

void Table::compare(const std::string& what, std::optional<double> prints, std::optional<double> follows,
                    double here, double tolerance, const char* unit) {
  const auto agrees = [&](const std::optional<double>& other) {
    return !other || std::abs(here - *other) <= tolerance;
  };
  const bool good = agrees(follows ? follows : prints);
  wrong_ += good ? 0 : 1;
  row(what, words_of(prints), words_of(follows), here, unit,
      !good             ? "  DIFFERS"
      : !agrees(prints) ? "  the print does not follow from the paper"
                        : "");
}

void Table::rule(const std::string& what, const std::string& prints, double here, bool kept,
                 const char* unit) {
  row(what, prints, "-", here, unit, kept ? "" : "  this machine file does not keep the paper's rule");
}

void Table::ours(const std::string& what, double here, const char* unit) {
  row(what, "-", "-", here, unit, "");
}

void Table::ours(const std::string& what, double here, double bound, const char* unit) {
  const bool good = here <= bound;
  wrong_ += good ? 0 : 1;
  row(what, "-", "-", here, unit, printed("  (ours: <= %.3g)%s", bound, good ? "" : " DIFFERS"));
}

MachineDescription shipped(const char* name) {
  auto machine = machine_of(name);
  if (!machine) throw std::runtime_error(machine.error());
  return std::move(*machine);
}

void Table::note(const std::string& words) {
  std::printf("  %s\n", words.c_str());
}

void write_text(const std::string& folder, const char* name, const std::string& text) {
  std::filesystem::create_directories(folder);
  const auto path = std::filesystem::path(folder) / name;
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

void write_picture(const std::string& folder, const char* name, const std::string& svg) {
  if (folder.empty()) return;
  write_text(folder, name, svg);
  std::printf("  picture: %s\n", (std::filesystem::path(folder) / name).c_str());
}

namespace {

int run(const std::string& paper, const std::string& folder) {
  int wrong = 0;
  const bool all = paper == "all";
  if (all || paper == "m1") wrong += m1(folder);
  if (all || paper == "m4") wrong += m4(folder);
  if (all || paper == "m5") wrong += m5(folder);
  std::printf("\n%s\n", wrong == 0 ? "what must agree agrees" : "SOME NUMBERS DIFFER");
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace kinebus::papers

int main(int argc, char** argv) {
  try {
    std::string paper = "all", folder;
    CLI::App app("What the papers print, what follows from their equations, and what comes out here");
    app.add_option("paper", paper, "m1, m4, m5 or all (default); M2 and M3: tools/papers")
        ->check(CLI::IsMember({"m1", "m4", "m5", "all"}));
    app.add_option("--pictures", folder, "Write pictures (SVG) into this folder");
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
      return app.exit(e) == 0 ? 0 : 2;
    }
    return kinebus::papers::run(paper, folder);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "kinebus-papers: %s\n", e.what());
    return 1;
  }
}
