// kinebus-dictionary eds|dbc [-o FILE]: prints what other CAN tools need to know of a Kinebus bus.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "protocol/host/guarded_main.hpp"
#include "tools/dictionary/dbc.hpp"
#include "tools/dictionary/eds.hpp"

namespace {

int print_dictionary(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  const bool to_file = argc == 4 && std::string(argv[2]) == "-o";
  if ((kind != "eds" && kind != "dbc") || (argc != 2 && !to_file)) {
    std::cerr << "usage: kinebus-dictionary eds|dbc [-o FILE]\n"
                 "  eds  electronic data sheet (CiA 306) of the two-axis node\n"
                 "  dbc  frames of a machine with nodes 1 to 3 and their gateway\n";
    return 2;
  }
  const std::string text = kind == "eds" ? kinebus::eds_text() : kinebus::dbc_text();
  if (!to_file) {
    std::cout << text << std::flush;
    return std::cout ? 0 : 1;
  }
  std::ofstream file(argv[3], std::ios::binary);
  file << text;
  file.close();
  if (file) return 0;
  std::perror(argv[3]);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-dictionary", [&] { return print_dictionary(argc, argv); });
}
