#include "tools/wiring/wiring.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

std::size_t count_of(std::string_view text, std::string_view word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

TEST(Wiring, EveryPinOfEveryBoardIsOnItsPictureOnce) {
  for (const WiringPage& page : wiring_pages()) {
    const std::string svg = draw_wiring(page);
    for (const stm32::Pin& pin : page.pins)
      EXPECT_EQ(count_of(svg, ">" + pin_name(pin) + "<"), 1u) << page.name << " " << pin_name(pin);
    EXPECT_EQ(svg, draw_wiring(page));
  }
}

TEST(Wiring, APinThatIsMovedInTheTableIsMovedInThePicture) {
  const WiringPage& page = wiring_pages().front();
  std::vector<stm32::Pin> pins(page.pins.begin(), page.pins.end());
  pins[0].number = 15;
  pins[0].port = stm32::Port::H;
  WiringPage other = page;
  other.pins = pins;
  EXPECT_NE(draw_wiring(other), draw_wiring(page));
  EXPECT_NE(draw_wiring(other).find(">PH15<"), std::string::npos);
}

}  // namespace
}  // namespace kinebus
