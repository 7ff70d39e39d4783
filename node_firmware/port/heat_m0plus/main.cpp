// The heat core alone as an image of a Cortex-M0+ without registers or pins: for what it takes of flash, RAM
// and cycles there, and that it does the same without floating point (vcan_tests/emulator runs it).

#include <optional>

#include "node_firmware/board/runtime.hpp"
#include "node_firmware/heat/heat_node.hpp"
#include "node_firmware/port/heat_m0plus/mailbox.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::heat_m0plus;

constinit std::optional<heat::HeatNode> node;

volatile std::uint32_t& at(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace

extern "C" {
extern std::uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;  // the linker script's
[[gnu::used]] constinit Mailbox mailbox;
int main();
[[noreturn]] void reset_handler();
[[noreturn]] void stands_still() {
  for (;;) {
  }
}
}

void kinebus::power_off_and_reset(std::uint16_t, const void*) {
  stands_still();
}

namespace {

LocalTime now() {
  return std::chrono::microseconds{mailbox.now_us};
}

void sample() {
  for (int i = 0; i < kHeatSensors; ++i)
    node->on_sample(now(), i, mailbox.ratios[static_cast<std::size_t>(i)]);
  for (int i = 0; i < kFans; ++i) node->on_tacho(i, 0);
  for (int i = 0; i < kFilamentSensors; ++i) node->on_filament(i, true, 0);
  node->on_probe_line(now(), false);
}

void hear() {
  CanFrame frame{.id = mailbox.frame_id, .length = static_cast<std::uint8_t>(mailbox.frame_length)};
  frame.data = mailbox.frame_data;
  node->on_frame(now(), frame);
}

void answer() {
  const auto frame = node->next_frame();
  mailbox.frame_id = frame ? frame->id : 0;
  if (!frame) return;
  mailbox.frame_length = frame->length;
  mailbox.frame_data = frame->data;
}

void do_work(Work work) {
  if (work == Work::kSamples) sample();
  if (work == Work::kTime) node->on_time(now());
  if (work == Work::kFrame) hear();
  if (work == Work::kAnswer) answer();
  // A port follows them behind every input.
  for (int i = 0; i < kHeaters; ++i) mailbox.power[static_cast<std::size_t>(i)] = node->heater_output(i);
}

}  // namespace

int main() {
  node.emplace(heat::HeatNodeOptions{.node_id = 20, .serial = 1}, LocalTime{0});
  for (;;) {
    const auto work = static_cast<Work>(at(kWorkRegister));
    if (work == Work::kNone) continue;
    asm volatile("" ::: "memory");  // the mailbox is written while nobody here does it
    do_work(work);
    asm volatile("" ::: "memory");
    at(kDoneRegister) = 1;
  }
}

void reset_handler() {
  const std::uint32_t* from = &data_load;
  for (std::uint32_t* to = &data_start; to != &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_start; to != &bss_end;) *to++ = 0;
  main();
  stands_still();
}

namespace {

using Handler = void (*)();
struct VectorTable {
  std::uint32_t* stack;
  Handler reset, nmi, hard_fault;
};
[[gnu::used, gnu::section(".vectors")]] const VectorTable vectors{&stack_top, reset_handler, stands_still,
                                                                  stands_still};

}  // namespace
