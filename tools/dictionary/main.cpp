// kinebus-dictionary eds|dbc [--board NAME] [-o FILE]: prints what other CAN tools need to know of a Kinebus
// bus.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "protocol/host/guarded_main.hpp"
#include "tools/dictionary/dbc.hpp"
#include "tools/dictionary/eds.hpp"

namespace {

using namespace kinebus;

std::string names_of_boards() {
  std::string names;
  for (const BoardDescription& board : kBoards)
    names += (names.empty() ? "" : ", ") + std::string(board.facts.name);
  return names;
}

int usage() {
  std::cerr << "usage: kinebus-dictionary eds|dbc [--board NAME] [-o FILE]\n"
               "  eds  electronic data sheet (CiA 306) of a board\n"
               "  dbc  frames of a machine with nodes 1 to 3, all of that board, and their gateway\n"
               "  --board NAME: "
            << names_of_boards() << "; " << kBoards[0].facts.name << " when none is named\n";
  return 2;
}

int print_dictionary(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (kind != "eds" && kind != "dbc") return usage();
  std::string name{kBoards[0].facts.name}, path;
  for (int i = 2; i < argc; i += 2) {
    const std::string option = argv[i];
    if ((option != "--board" && option != "-o") || i + 1 == argc) return usage();
    (option == "-o" ? path : name) = argv[i + 1];
  }
  const BoardDescription* board = find_board(name);
  if (board == nullptr) {
    std::cerr << "kinebus-dictionary: --board " << name
              << ": there is no such board; one of: " << names_of_boards() << "\n";
    return 2;
  }
  const std::string text = kind == "eds" ? eds_text(*board) : dbc_text(*board);
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

}  // namespace

int main(int argc, char** argv) {
  return guarded_main("kinebus-dictionary", [&] { return print_dictionary(argc, argv); });
}
