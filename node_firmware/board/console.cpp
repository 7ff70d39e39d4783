#include "node_firmware/board/console.hpp"

#include <algorithm>

namespace kinebus {
namespace {

// In full, so that nothing that is typed or sent by mistake is it.
constexpr std::string_view kSystemBoot = "DFU";
constexpr std::string_view kOffTheBus = " OFF THE BUS", kNoBus = " NO BUS";
constexpr std::string_view kOtherBoard = " THE IMAGE IS FOR ANOTHER BOARD: NOTHING IS DRIVEN";
/// By ResetCause.
constexpr std::array<std::string_view, 6> kCauses{"power-on", "reset pin", "brown-out",
                                                  "watchdog", "program",   "other"};

}  // namespace

Console& Console::put(std::string_view text) {
  const std::size_t count = std::min(text.size(), text_.size() - length_);
  std::copy_n(text.begin(), count, text_.begin() + static_cast<std::ptrdiff_t>(length_));
  length_ += count;
  return *this;
}

Console& Console::put(std::int64_t number) {
  // What is shown fits 32 bits, which spares a division of 64.
  constexpr std::int64_t kMost = 0xFFFF'FFFF;
  auto rest = static_cast<std::uint32_t>(std::min(number < 0 ? -number : number, kMost));
  std::array<char, 11> digits{};
  std::size_t at = digits.size();
  do {
    digits[--at] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest != 0);
  if (number < 0) digits[--at] = '-';
  return put(std::string_view(digits.data() + at, digits.size() - at));
}

Console& Console::put_hex(std::uint32_t number) {
  std::array<char, 8> digits{};
  for (std::size_t at = digits.size(); at-- > 0; number >>= 4) digits[at] = "0123456789ABCDEF"[number & 0xF];
  return put(std::string_view(digits.data(), digits.size()));
}

void Console::reset(const ResetReport& report) {
  put("reset by ").put(kCauses[static_cast<std::size_t>(report.cause)]);
  if (report.reason != fault_reason::kNone) {
    put(" fault ").put(report.reason).put(" PC ").put_hex(report.pc).put(" LR ").put_hex(report.lr);
    put(" CFSR ").put_hex(report.cfsr).put(" HFSR ").put_hex(report.hfsr).put(" at ").put_hex(report.address);
  }
  put("\r\n");
}

void Console::axis(int axis, const Subject& subject) {
  const motor::AxisControl& control = subject.motors.control(axis);
  const DriveAxis& drive = subject.node.axis(axis);
  put(std::string_view(axis == 0 ? "A" : "B", 1)).put(": state ").put(static_cast<int>(drive.state()));
  put(" mode ").put(drive.mode_display()).put(" error ").put(drive.error_code());
  put(" current mA ").put(static_cast<std::int32_t>(control.amplitude_a() * 1e3F));
  put(" off course ").put(control.following_error()).put(" troubles ").put(control.troubles());
  put(" encoder errors ").put(control.encoder().errors());
  put(" C ")
      .put(static_cast<std::int32_t>(subject.motors.readings().temperature_c[static_cast<std::size_t>(axis)]))
      .put("\r\n");
}

void Console::answer(char letter, const Subject& subject) {
  const Node& node = subject.node;
  switch (letter) {
    case 's':
      put("node ").put(node.node_id()).put(" NMT ").put(static_cast<int>(node.nmt_state()));
      put(" supply mV ")
          .put(static_cast<std::int32_t>(subject.motors.readings().supply_v * 1e3F))
          .put(subject.own_board ? std::string_view() : kOtherBoard)
          .put("\r\n");
      axis(0, subject);
      axis(1, subject);
      break;
    case 'c':
      put("CAN overruns ").put(subject.can.overruns).put(" bus-off ").put(subject.can.bus_off);
      put(" passive ")
          .put(subject.can.passive)
          .put(subject.no_bus        ? kNoBus
               : subject.off_the_bus ? kOffTheBus
                                     : std::string_view())
          .put("\r\n");
      break;
    case 'r':
      reset(node.reset_report());
      break;
    case 't':
      put("control cycles last ").put(subject.cycles.last).put(" worst ").put(subject.cycles.worst);
      put(" interrupts ").put(subject.control_interrupts).put("\r\n");
      break;
    case 'v':
      put("Kinebus node, serial ")
          .put(subject.serial)
          .put(" image bytes ")
          .put(subject.image_bytes)
          .put("\r\n");
      break;
    default:
      put("s state, c CAN, r reset, t timing, v version, DFU: USB boot loader\r\n");
      break;
  }
}

void Console::hear(char letter, const Subject& subject) {
  if (letter != kSystemBoot[matched_]) matched_ = 0;
  if (letter != kSystemBoot[matched_]) return answer(letter, subject);
  if (++matched_ < kSystemBoot.size()) return;
  matched_ = 0;
  request_system_boot(subject.node);
}

void Console::request_system_boot(const Node& node) {
  // A platform on vertical rails would fall without power; the boot loader has none to give.
  if (node.axis(0).powered() || node.axis(1).powered()) {
    put("refused: an axis has power\r\n");
    return;
  }
  system_boot_requested_ = true;
}

void Console::sent(std::size_t count) {
  sent_ += count;
  if (sent_ >= length_) forget();
}

void Console::forget() {
  sent_ = length_ = 0;
}

}  // namespace kinebus
