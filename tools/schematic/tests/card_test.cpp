#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tools/schematic/bill.hpp"
#include "tools/schematic/rules.hpp"
#include "tools/schematic/tests/card_check.hpp"
#include "tools/schematic/tests/mentions.hpp"

namespace kinebus::schematic {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> all_complaints(const Netlist& netlist) {
  const Circuit circuit(netlist);
  std::vector<std::string> found = check_rules(netlist);
  for (const auto& lines : {check_pins(circuit), check_stages(circuit), check_ratings(circuit)})
    found.insert(found.end(), lines.begin(), lines.end());
  return found;
}

/// The card with one thing changed in one of its files: each place where `before` stands, or only the first.
class ChangedCard {
 public:
  std::vector<std::string> complaints(const std::string& file, const std::string& before,
                                      const std::string& after, bool all = true) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("kinebus-card-" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::copy(std::filesystem::path(KINEBUS_CARD).parent_path(), folder);
    std::string text = text_of(folder / file);
    std::size_t at = text.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    for (; at != std::string::npos; at = all ? text.find(before, at + after.size()) : std::string::npos)
      text.replace(at, before.size(), after);
    std::ofstream(folder / file, std::ios::binary) << text;
    const auto netlist = read_netlist(folder / "kinebus-card.kicad_sch");
    EXPECT_TRUE(netlist) << netlist.error().text();
    auto found = all_complaints(*netlist);
    std::filesystem::remove_all(folder);
    return found;
  }
};

TEST(Card, IsWhatTheFirmwareDrives) {
  const auto netlist = read_netlist(KINEBUS_CARD);
  ASSERT_TRUE(netlist) << netlist.error().text();
  for (const std::string& line : all_complaints(*netlist)) ADD_FAILURE() << line;
}

TEST(Card, BillIsTheSchematics) {
  const auto netlist = read_netlist(KINEBUS_CARD);
  ASSERT_TRUE(netlist) << netlist.error().text();
  EXPECT_EQ(text_of(std::filesystem::path(KINEBUS_CARD).parent_path() / "bill.csv"),
            bill_of_materials(*netlist))
      << "kinebus-schematic bill " << KINEBUS_CARD;
}

TEST(Card, TwoPinsThatChangePlacesAreFound) {
  // At the microcontroller alone: its label is the first of that name.
  const auto found = ChangedCard().complaints("mcu.kicad_sch", "(label \"SW_1\"", "(label \"SW_2\"", false);
  EXPECT_TRUE(mentions(found, "PB0"));
}

TEST(Card, AnotherShuntDividerOrThresholdIsFound) {
  EXPECT_TRUE(mentions(
      ChangedCard().complaints("phase.kicad_sch", "(property \"Gain\" \"20\"", "(property \"Gain\" \"50\""),
      "volts per ampere"));
  EXPECT_TRUE(mentions(ChangedCard().complaints("stage.kicad_sch", "(property \"Value\" \"11.3k\"",
                                                "(property \"Value\" \"8.2k\""),
                       "trips at"));
  EXPECT_TRUE(mentions(ChangedCard().complaints("power.kicad_sch", "(property \"Value\" \"47k\"",
                                                "(property \"Value\" \"68k\""),
                       "divider"));
  EXPECT_TRUE(
      mentions(ChangedCard().complaints("stage.kicad_sch", "\"3435 K\"", "\"3950 K\""), "thermistor's B"));
  EXPECT_TRUE(mentions(ChangedCard().complaints("phase.kicad_sch", "(property \"Value\" \"24.3k\"",
                                                "(property \"Value\" \"10k\""),
                       "dead time"));
}

TEST(Card, PartsThatDoNotStandTheSupplyAreFound) {
  EXPECT_TRUE(mentions(ChangedCard().complaints("phase.kicad_sch", "(property \"Voltage\" \"60 V\"",
                                                "(property \"Voltage\" \"40 V\""),
                       "40 V for 48.4 V"));
  EXPECT_TRUE(mentions(ChangedCard().complaints("stage.kicad_sch", "(property \"Voltage\" \"63 V\"",
                                                "(property \"Voltage\" \"50 V\""),
                       "50 V for 48.4 V"));
  EXPECT_TRUE(
      mentions(ChangedCard().complaints("power.kicad_sch", "\"Standoff\" \"30 V\"", "\"Standoff\" \"28 V\""),
               "still goes on"));
}

TEST(Card, AShuntTurnedRoundIsFound) {
  // The amplifier's inputs change places: the label at IN+ becomes that of IN-.
  EXPECT_TRUE(mentions(ChangedCard().complaints("phase.kicad_sch", "(name \"IN+\"", "(name \"IN-\"", false),
                       "no amplifier"));
}

TEST(Card, AWireThatIsCutIsFound) {
  EXPECT_TRUE(
      mentions(ChangedCard().complaints("mcu.kicad_sch", "(label \"XTAL_IN\"", "(label \"NOWHERE\"", false),
               "crystal"));
  EXPECT_TRUE(mentions(ChangedCard().complaints("io.kicad_sch", "(hierarchical_label \"SW_3\"",
                                                "(hierarchical_label \"SW_X\""),
                       "SW_3"));
}

}  // namespace
}  // namespace kinebus::schematic
