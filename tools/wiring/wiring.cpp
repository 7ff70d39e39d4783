#include "tools/wiring/wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "node_firmware/port/stm32f405/board.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "tools/drawing/document.hpp"

namespace kinebus {
namespace {

using drawing::Anchor;
using drawing::Document;
using stm32::Mode;
using stm32::Pin;
using stm32::Pull;

constexpr double kRow = 22, kTop = 104, kMargin = 24, kColumn = 570, kPinWidth = 52, kWireLength = 46;
constexpr double kBottom = 56;

struct Kind {
  std::string_view colour, words;
};
/// How a pin is used: its colour, and the legend's words.
Kind kind_of(const Pin& pin) {
  switch (pin.mode) {
    case Mode::kOutput:
      return {"#b3541e", "output"};
    case Mode::kInput:
      return {"#1f6f8b", "input"};
    case Mode::kAnalogue:
      return {"#3a7d44", "analogue"};
    default:
      return {"#5a4e9c", "alternate function"};
  }
}

/// What it is before and after the program has begun.
std::string state_of(const Pin& pin) {
  const std::string_view pull = pin.pull == Pull::kUp     ? "pulled up"
                                : pin.pull == Pull::kDown ? "pulled down"
                                                          : "";
  if (pin.mode == Mode::kOutput) return pin.high ? "high at reset" : "low at reset";
  if (pin.mode == Mode::kAlternate)
    return fmt::format("AF{}{}{}", pin.alternate, pull.empty() ? "" : ", ", pull);
  return std::string(pull);
}

/// Arrows: out of the chip, into it.
void draw_wire(Document& svg, double x, double y, const Pin& pin, std::string_view colour) {
  const double end = x + kWireLength;
  svg.line({x, y}, {end, y}, {.stroke = colour, .width = 1.6});
  const auto head = [&](double tip, double back) {
    const std::array<drawing::Point, 3> points{{{tip, y}, {back, y - 3.5}, {back, y + 3.5}}};
    svg.polygon(points, {.fill = colour});
  };
  if (pin.mode == Mode::kOutput) head(end, end - 7);
  if (pin.mode == Mode::kInput || pin.mode == Mode::kAnalogue) head(x, x + 7);
}

void draw_pin(Document& svg, double x, double y, const Pin& pin) {
  const Kind kind = kind_of(pin);
  svg.rectangle({x, y - 8, kPinWidth, 16}, {.fill = kind.colour}, 3);
  svg.text({x + kPinWidth / 2, y + 4}, pin_name(pin),
           {.size = 11, .anchor = Anchor::kMiddle, .fill = "white", .bold = true});
  draw_wire(svg, x + kPinWidth, y, pin, kind.colour);
  const std::string state = state_of(pin);
  svg.text({x + kPinWidth + kWireLength + 6, y}, pin.signal, {.size = 11, .fill = drawing::kInk});
  svg.text({x + kPinWidth + kWireLength + 6, y + 9}, state, {.size = 8, .fill = drawing::kMuted});
}

void draw_legend(Document& svg, double y) {
  static constexpr std::array kModes{Mode::kOutput, Mode::kInput, Mode::kAnalogue, Mode::kAlternate};
  double x = kMargin;
  for (const Mode mode : kModes) {
    const Kind kind = kind_of(Pin{stm32::Port::A, 0, mode, Pull::kNone, 0, false, ""});
    svg.rectangle({x, y - 9, 14, 12}, {.fill = kind.colour}, 2);
    svg.text({x + 20, y + 1}, kind.words, {.size = 11, .fill = drawing::kMuted});
    x += 150;
  }
}

/// What a program makes of the EBB's pins: its own come in the others' place. kMore: that have none there.
template <std::size_t kMore, std::size_t kOwn>
constexpr auto ebb_pins_with(const std::array<Pin, kOwn>& own) {
  std::array<Pin, ebb::kPins.size() + kMore> all{};
  std::size_t count = 0;
  for (const Pin& pin : ebb::kPins) all[count++] = pin;
  for (const Pin& mine : own) {
    std::size_t at = 0;
    while (at < count && (all[at].port != mine.port || all[at].number != mine.number)) ++at;
    all[at] = mine;
    if (at == count) ++count;
  }
  return all;
}
constexpr auto kEbbAxisPins = ebb_pins_with<0>(ebb::kAxisPins);
constexpr auto kEbbHeatPins = ebb_pins_with<6>(ebb::kHeatPins);  // those of both SPIs
static_assert(stm32::pins_differ(kEbbAxisPins) && stm32::pins_differ(kEbbHeatPins));

constexpr std::array kPages{
    WiringPage{"f405", "node_firmware/port/stm32f405", "wiring.svg", "The dual-stepper board: STM32F405RG",
               "From board.hpp  Arrows point out of the chip or into it.", board::kPins},
    WiringPage{"octopus", "node_firmware/port/stm32f446_octopus", "wiring.svg",
               "BTT Octopus v1.0, v1.1: STM32F446ZE",
               "From board.hpp  Arrows point out of the chip or into it.", octopus::kPins},
    WiringPage{"ebb", "node_firmware/port/stm32g0b1_ebb", "wiring.svg",
               "BTT EBB36, EBB42 v1.1, v1.2: STM32G0B1CB, the extruder's axis",
               "From board.hpp  Arrows point out of the chip or into it.", kEbbAxisPins},
    WiringPage{"ebb-heat", "node_firmware/port/stm32g0b1_ebb", "wiring_heat.svg",
               "BTT EBB36, EBB42 v1.1, v1.2: STM32G0B1CB, the heat node",
               "From board.hpp  Arrows point out of the chip or into it.", kEbbHeatPins},
};

}  // namespace

std::span<const WiringPage> wiring_pages() {
  return kPages;
}

std::string pin_name(const Pin& pin) {
  return fmt::format("P{}{}", static_cast<char>('A' + static_cast<int>(pin.port)), pin.number);
}

std::string draw_wiring(const WiringPage& page) {
  const std::size_t rows = (page.pins.size() + 1) / 2;
  const double height = kTop + kRow * static_cast<double>(rows) + kBottom;
  Document svg(2 * kMargin + 2 * kColumn, height);
  svg.heading(kMargin, page.title, page.subtitle);
  for (std::size_t i = 0; i < page.pins.size(); ++i)
    draw_pin(svg, kMargin + (i < rows ? 0 : kColumn), kTop + kRow * static_cast<double>(i % rows),
             page.pins[i]);
  draw_legend(svg, height - kBottom / 2 + 8);
  return svg.svg();
}

}  // namespace kinebus
