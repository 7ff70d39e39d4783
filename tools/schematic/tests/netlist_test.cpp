#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tools/schematic/netlist.hpp"
#include "tools/schematic/rules.hpp"
#include "tools/schematic/tests/mentions.hpp"

namespace kinebus::schematic {
namespace {

/// Two resistors R1 at 10, 10 and R2 at 20, 10 mm, pins above (1) and below (2) by 5 mm, and more.
std::string drawing(const std::string& more) {
  const std::string pins =
      R"(((symbol "R_1_1" (pin passive line (at 0 5 270) (length 1) (name "~") (number "1")) (pin passive line (at 0 -5 90) (length 1) (name "~") (number "2")))))";
  const auto resistor = [](const std::string& name, const std::string& at) {
    return "(symbol (lib_id \"t:R\") (at " + at + ") (unit 1) (in_bom yes) (uuid " + name +
           ") (property \"Reference\" \"" + name + "\") (property \"Value\" \"1k\"))";
  };
  return "(kicad_sch (lib_symbols (symbol \"t:R\" " + pins.substr(1, pins.size() - 2) + "))" +
         resistor("R1", "10 10 0") + resistor("R2", "20 10 0") + more + ")";
}

class Drawn {
 public:
  explicit Drawn(const std::string& text)
      : file_(std::filesystem::temp_directory_path() /
              ("kinebus-" + std::to_string(::getpid()) + ".kicad_sch")) {
    std::ofstream(file_) << text;
  }
  ~Drawn() { std::filesystem::remove(file_); }
  Drawn(const Drawn&) = delete;
  Drawn& operator=(const Drawn&) = delete;
  Netlist netlist() const {
    auto read = read_netlist(file_);
    EXPECT_TRUE(read) << read.error().text();
    return read ? *read : Netlist{};
  }
  std::string error() const { return read_netlist(file_).error().text(); }

 private:
  std::filesystem::path file_;
};

bool connected(const Netlist& netlist, const char* pin_1, const char* pin_2) {
  return netlist.net_of("R1", pin_1) == netlist.net_of("R2", pin_2);
}

TEST(Netlist, WiresConnectTheirEnds) {
  const Netlist netlist = Drawn(drawing("(wire (pts (xy 10 5) (xy 20 5)))")).netlist();
  EXPECT_TRUE(connected(netlist, "1", "1"));
  EXPECT_FALSE(connected(netlist, "2", "2"));
}

TEST(Netlist, LabelsOfOneNameConnect) {
  const Netlist netlist = Drawn(drawing("(wire (pts (xy 10 5) (xy 12 5)))(label \"A\" (at 12 5 0))"
                                        "(wire (pts (xy 20 15) (xy 20 25)))(label \"A\" (at 20 20 0))"))
                              .netlist();
  EXPECT_TRUE(connected(netlist, "1", "2"));
  EXPECT_EQ(netlist.net_of("R1", "1")->name, "/A");
}

TEST(Netlist, CrossingWiresConnectByAJunctionAlone) {
  const std::string cross =
      "(wire (pts (xy 10 5) (xy 10 0)))(wire (pts (xy 5 2) (xy 20 2)))(wire (pts (xy 20 2) (xy 20 5)))";
  EXPECT_FALSE(connected(Drawn(drawing(cross)).netlist(), "1", "1"));
  EXPECT_TRUE(connected(Drawn(drawing(cross + "(junction (at 10 2))")).netlist(), "1", "1"));
}

TEST(Netlist, AWireThatEndsOnAnotherWithoutAJunctionIsNamed) {
  const Netlist netlist =
      Drawn(drawing("(wire (pts (xy 10 5) (xy 30 5)))(wire (pts (xy 25 0) (xy 25 5)))")).netlist();
  EXPECT_TRUE(mentions(netlist.complaints, "25.00, 5.00 mm: a wire ends on the middle"));
  EXPECT_TRUE(mentions(netlist.complaints, "R2 has a pin on the middle"));
}

TEST(Netlist, TurnedAndMirroredSymbolsHaveTheirPinsWhereTheyAreDrawn) {
  // R2 lies: pin 1 at the left, mirrored at the right.
  std::string text = drawing(
      "(wire (pts (xy 10 15) (xy 10 20) ))(wire (pts (xy 10 5) (xy 15 5)))(wire (pts (xy 15 5) (xy 15 10)))");
  text.replace(text.find("20 10 0"), 7, "20 10 90");
  EXPECT_TRUE(connected(Drawn(text).netlist(), "1", "1"));
  text.replace(text.find("20 10 90)"), 9, "20 10 90) (mirror y)");
  EXPECT_TRUE(connected(Drawn(text).netlist(), "1", "2"));
}

TEST(Rules, OpenPinsAndMarksOnConnectedPinsAreNamed) {
  const auto found = check_rules(
      Drawn(drawing("(wire (pts (xy 10 5) (xy 20 5)))(no_connect (at 10 5))(no_connect (at 10 15))"))
          .netlist());
  EXPECT_TRUE(mentions(found, "R1.1 (~) is marked as not connected"));
  EXPECT_TRUE(mentions(found, "R2.2 (~) is not connected"));
  EXPECT_FALSE(mentions(found, "R1.2"));
  EXPECT_TRUE(mentions(found, "R1 has no MPN"));
}

TEST(Rules, OutputsAgainstEachOtherAndSuppliesThatNothingFeedsAreNamed) {
  std::string text = drawing("(wire (pts (xy 10 5) (xy 20 5)))(wire (pts (xy 10 15) (xy 20 15)))");
  text.replace(text.find("pin passive"), 11, "pin output");
  text.replace(text.find("pin passive"), 11, "pin power_in");
  const auto found = check_rules(Drawn(text).netlist());
  EXPECT_TRUE(mentions(found, "outputs against each other"));
  EXPECT_TRUE(mentions(found, "nothing feeds"));
}

TEST(SchematicFile, BadInputIsAnErrorWithItsPlace) {
  EXPECT_TRUE(mentions({Drawn("(kicad_sch\n(wire").error()}, ":2: "));
  EXPECT_TRUE(mentions({Drawn("(kicad_pcb)").error()}, "no schematic of KiCad 6"));
  EXPECT_TRUE(mentions({Drawn("(kicad_sch \"x").error()}, "has no end"));
  EXPECT_TRUE(mentions({Drawn(std::string(500, '(')).error()}, "more than 100 lists"));
  EXPECT_TRUE(mentions({Drawn("(kicad_sch (symbol (lib_id \"t:R\")))").error()}, "no symbol \"t:R\""));
  EXPECT_TRUE(mentions({read_netlist("/nowhere.kicad_sch").error().text()}, "cannot be read"));
}

}  // namespace
}  // namespace kinebus::schematic
