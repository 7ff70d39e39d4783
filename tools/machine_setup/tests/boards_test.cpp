#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/machine_setup/boards_report.hpp"
#include "tools/machine_setup/tests/setup_rig.hpp"

namespace kinebus {
namespace {

BoardsReport report_of(SetupRig& rig) {
  const SetupHost host = rig.host();
  NodeIds ids(host.bus, {});
  BoardsReport report{.interface = "can7"};
  report.bus = find_bus_boards(host.bus, ids);
  return report;
}

TEST(Boards, AreListedByWhatTheyAreAndTroublesAreNamed) {
  SetupRig rig;
  rig.add_board(Stm32f405Board::kFacts, 501, 3);
  rig.add_board(Stm32f405Board::kFacts, 502, 3);
  rig.add_board(Stm32f446OctopusBoard::kFacts, 900, 5);
  rig.add_board(Stm32f405Board::kFacts, 7);
  rig.add_heat(20);
  const BoardsReport report = report_of(rig);
  const std::string text = as_text(report);
  for (const char* words :
       {"On can7:", "node 20  heat node            serial number 77",
        "node 5   axis pair            serial number 900", "no id    axis pair            serial number 7 ",
        "! node 3 is the id of 2 boards, serial numbers 501 and 502", "--serial 502",
        "! 1 board has no node id yet"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  const auto json = nlohmann::json::parse(as_json(report));
  ASSERT_EQ(json["bus"].size(), 5u);
  EXPECT_EQ(json["bus"][0]["shares_id"], true);
  EXPECT_EQ(json["bus"][2]["board"], "stm32f446_octopus");
  EXPECT_EQ(json["bus"][4]["node"], nullptr);
  EXPECT_EQ(json["troubles"].size(), 2u);
}

TEST(Boards, NobodyThereIsSaidWithWhatToLookAt) {
  SetupRig rig;
  EXPECT_NE(as_text(report_of(rig)).find("no board answers: has it power"), std::string::npos);
  EXPECT_NE(as_text({.interface = "can0", .bus_trouble = "down"}).find("  down\n"), std::string::npos);
}

TEST(UsbBoardsByTheirNumbers, AreToldApart) {
  EXPECT_EQ(usb_kind(0x1D50, 0x606F, "candleLight"), UsbKind::kCanAdapter);
  EXPECT_EQ(usb_kind(0x1209, 0x2323, ""), UsbKind::kCanAdapter);
  EXPECT_EQ(usb_kind(0x0483, 0xDF11, "STM32  BOOTLOADER"), UsbKind::kBootLoader);
  EXPECT_EQ(usb_kind(0x0483, 0x5740, "Kinebus node"), UsbKind::kNodeConsole);
  EXPECT_EQ(usb_kind(0x0483, 0x5740, "STM32 Virtual ComPort"), UsbKind::kOther);
  EXPECT_EQ(usb_kind(0x1D50, 0x614E, "stm32f446xx"), UsbKind::kKlipper);
  EXPECT_EQ(usb_kind(0x046D, 0xC31C, "Keyboard"), UsbKind::kOther);
  const std::string text = as_text(
      {.interface = "can0",
       .usb = {{{.vendor = 0x483, .product = 0xDF11, .name = "x", .kind = UsbKind::kBootLoader}}, ""}});
  EXPECT_NE(text.find("0483:df11 boot loader of an STM32 (DFU): x"), std::string::npos) << text;
  EXPECT_NE(text.find("kinebus-flash --dfu"), std::string::npos);
}

}  // namespace
}  // namespace kinebus
