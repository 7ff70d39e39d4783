// kinebus-schematic: what a schematic of KiCad 6 connects, what is wrong with it, and what to order. KiCad is
// not needed.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "protocol/host/guarded_main.hpp"
#include "protocol/host/usage.hpp"
#include "tools/schematic/bill.hpp"
#include "tools/schematic/netlist.hpp"
#include "tools/schematic/rules.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::schematic;

void print_nets(const Netlist& netlist) {
  for (const Net& net : netlist.nets) {
    std::string pins;
    for (const auto [part_index, pin_index] : net.pins) {
      const Part& part = netlist.parts[part_index];
      if (!part.power) pins += fmt::format(" {}.{}", part.reference, part.pins[pin_index].number);
    }
    fmt::print("{}:{}\n", net.name, pins);
  }
}

/// The bill of materials beside the schematic: written, or compared with what stands there.
int serve_bill(const Netlist& netlist, const std::filesystem::path& file, bool compare) {
  const std::string bill = bill_of_materials(netlist);
  if (compare) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream there;
    there << in.rdbuf();
    if (in && there.str() == bill) return 0;
    fmt::print(stderr, "{} is not the schematic's bill of materials: kinebus-schematic bill writes it anew\n",
               file.string());
    return 1;
  }
  std::ofstream out(file, std::ios::binary);
  out << bill << std::flush;
  if (!out) return fmt::print(stderr, "{} cannot be written\n", file.string()), 1;
  fmt::print("{}\n", file.string());
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app("kinebus-schematic: reads a schematic of KiCad 6 with all its sheets.");
  std::string root;
  bool compare = false;
  app.require_subcommand(1);
  auto* nets = app.add_subcommand("nets", "Prints each net and its pins");
  auto* check =
      app.add_subcommand("check", "Electrical rules: prints what is wrong; status 1 when something is");
  auto* bill = app.add_subcommand("bill", "Writes bill.csv beside the schematic");
  for (auto* command : {nets, check, bill})
    command->add_option("schematic", root, "The root sheet (.kicad_sch)")
        ->required()
        ->check(CLI::ExistingFile);
  bill->add_flag("--check", compare, "Write nothing: status 1 when bill.csv is not the schematic's");
  if (const auto end = parse_arguments(app, argc, argv)) return *end;
  const auto netlist = read_netlist(root);
  if (!netlist) return fmt::print(stderr, "{}\n", netlist.error().text()), 1;
  if (*nets) return print_nets(*netlist), 0;
  if (*bill) return serve_bill(*netlist, std::filesystem::path(root).parent_path() / "bill.csv", compare);
  const auto found = check_rules(*netlist);
  for (const std::string& line : found) fmt::print("{}\n", line);
  fmt::print("{} parts, {} nets, {} complaints\n", netlist->parts.size(), netlist->nets.size(), found.size());
  return found.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-schematic", [&] { return run(argc, argv); });
}
