// kinebus-dictionary eds|dbc|wireshark: prints what other CAN tools need to know of a Kinebus bus.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "protocol/host/guarded_main.hpp"
#include "tools/dictionary/dbc.hpp"
#include "tools/dictionary/eds.hpp"
#include "tools/dictionary/wireshark.hpp"

namespace {

using namespace kinebus;

int usage() {
  std::cerr
      << "usage: kinebus-dictionary eds|dbc [--board NAME] [--nodes LIST] [-o FILE]\n"
         "       kinebus-dictionary wireshark [-o FILE]\n"
         "  eds        electronic data sheet (CiA 306) of a board\n"
         "  dbc        frames of a machine's nodes and their gateway\n"
         "  wireshark  dissector in Lua for Wireshark and tshark, of all boards and node ids\n"
         "  --board NAME: "
      << names_of_boards() << "; " << kBoards[0].facts.name
      << " when none is named\n"
         "  --nodes LIST: node ids 1 to 126, a board behind those that are of another one: 1-3,20:heat; "
         "1-3 when not given\n";
  return 2;
}

int wrong(const std::string& what) {
  std::cerr << "kinebus-dictionary: " << what << "\n";
  return 2;
}

int write_text(const std::string& path, const std::string& text) {
  if (path.empty()) {
    std::cout << text << std::flush;
    return std::cout ? 0 : 1;
  }
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (file) return 0;
  std::perror(path.c_str());
  return 1;
}

int print_dictionary(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (kind != "eds" && kind != "dbc" && kind != "wireshark") return usage();
  std::string name{kBoards[0].facts.name}, list, path;
  for (int i = 2; i < argc; i += 2) {
    const std::string option = argv[i];
    std::string* value = option == "-o"                               ? &path
                         : option == "--board" && kind != "wireshark" ? &name
                         : option == "--nodes" && kind == "dbc"       ? &list
                                                                      : nullptr;
    if (value == nullptr || i + 1 == argc) return usage();
    *value = argv[i + 1];
  }
  if (kind == "wireshark") return write_text(path, wireshark_text());
  const BoardDescription* board = find_board(name);
  if (board == nullptr)
    return wrong("--board " + name + ": there is no such board; one of: " + names_of_boards());
  if (kind == "eds") return write_text(path, eds_text(*board));
  if (list.empty()) return write_text(path, dbc_text(nodes_of(*board)));
  const NodeList nodes = read_nodes(list, *board);
  if (!nodes.error.empty()) return wrong("--nodes " + list + ": " + nodes.error);
  return write_text(path, dbc_text(nodes.nodes));
}

}  // namespace

int main(int argc, char** argv) {
  return guarded_main("kinebus-dictionary", [&] { return print_dictionary(argc, argv); });
}
