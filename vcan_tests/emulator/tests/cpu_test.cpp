// The processor runs guest programs that check it from inside; the system control space is also tested on its
// own.

#include <gtest/gtest.h>

#include <array>

#include "vcan_tests/emulator/cpu/cortex_m4.hpp"
#include "vcan_tests/emulator/cpu/cycle_estimate.hpp"

namespace kinebus::emulator {
namespace {

class NoDevices final : public Devices {
 public:
  std::uint32_t read(std::uint32_t, int, Cycle) override { return 0; }
  void write(std::uint32_t, std::uint32_t, int, Cycle) override {}
  bool write_flash(std::uint32_t, std::uint32_t, int, Cycle) override { return false; }
  Cycle next_event() const override { return kNever; }
  void advance(Cycle) override {}
};

constexpr std::array kResultNames{
    "done", "nesting", "tail chaining", "BASEPRI", "PRIMASK", "float",           "IT block",
    "WFI",  "SVC",     "PendSV",        "CYCCNT",  "IPSR",    "stack alignment", "IT block across a page"};

struct Guest {
  explicit Guest(Cycle quantum) : image(load_elf(KINEBUS_GUEST_DIR "/core_guest.elf")), cpu(devices) {
    cpu.load(image);
    cpu.reset();
    cpu.poke(*image.symbol("seed_value"), 12345);
    for (Cycle end = 0; end < 600'000'000 && result(0) != 0x600D;) cpu.run(end += quantum);
  }
  std::uint32_t result(std::uint32_t index) { return cpu.peek(*image.symbol("results") + 4 * index); }
  NoDevices devices;
  ElfImage image;
  CortexM4 cpu;
};

TEST(CortexM4, DoesWhatTheGuestProgramExpects) {
  Guest guest(1'000'000);
  EXPECT_EQ(guest.result(0), 0x600Du);
  for (std::uint32_t i = 1; i < kResultNames.size(); ++i) EXPECT_EQ(guest.result(i), 1u) << kResultNames[i];
  EXPECT_GT(guest.result(14), 1000u) << "ticks of SysTick";
}

TEST(CortexM4, TheSameRunWhateverTheQuantum) {
  Guest coarse(1'000'000), fine(6'720);
  EXPECT_EQ(coarse.result(14), fine.result(14));
  EXPECT_EQ(coarse.cpu.cost(kSysTick).calls, fine.cpu.cost(kSysTick).calls);
  EXPECT_EQ(coarse.cpu.cost(kSysTick).instructions, fine.cpu.cost(kSysTick).instructions);
}

TEST(CortexM4, CountsAnInterruptsInstructionsWithoutThoseThatPreemptIt) {
  Guest guest(1'000'000);
  const ExceptionCost& high = guest.cpu.cost(kFirstInterrupt + 1);
  EXPECT_EQ(high.calls, 2u);
  EXPECT_GT(high.worst_instructions, 5u);
  EXPECT_LT(high.worst_instructions, 30u);
  EXPECT_LT(guest.cpu.cost(kFirstInterrupt).worst_instructions, 60u);
}

TEST(Nvic, PriorityGroupsDecideWhoPreempts) {
  Nvic nvic;
  nvic.write(0xE100, 3, 0);
  nvic.write_part(0xE400, 0x40, 1, 0);
  nvic.write_part(0xE401, 0x50, 1, 0);
  nvic.write(0xED0C, 0x05FA0000u | 5u << 8, 0);  // two bits of group, two of sub-priority
  nvic.pend(kFirstInterrupt + 1);
  nvic.enter(nvic.next_exception({}));
  nvic.pend(kFirstInterrupt);
  EXPECT_EQ(nvic.next_exception({}), kThread) << "more urgent, but in the same group";
  nvic.leave(kFirstInterrupt + 1);
  EXPECT_EQ(nvic.next_exception({}), kFirstInterrupt);
}

TEST(Nvic, ALineThatStaysHighAsksAgain) {
  Nvic nvic;
  nvic.write(0xE100, 1, 0);
  nvic.set_line(0, true);
  nvic.enter(nvic.next_exception({}));
  nvic.leave(kFirstInterrupt);
  EXPECT_EQ(nvic.next_exception({}), kFirstInterrupt);
  nvic.enter(kFirstInterrupt);
  nvic.set_line(0, false);
  nvic.leave(kFirstInterrupt);
  EXPECT_EQ(nvic.next_exception({}), kThread);
}

TEST(CycleEstimate, KnowsTheExpensiveInstructions) {
  const auto cycles = [](std::initializer_list<std::uint16_t> code) {
    return estimate_cost({code.begin(), code.size()}).cycles;
  };
  EXPECT_EQ(cycles({0x4408}), 1u);           // add r0, r1
  EXPECT_EQ(cycles({0x6801, 0x6842}), 3u);   // two loads in a row
  EXPECT_EQ(cycles({0xEE80, 0x0A20}), 14u);  // vdiv.f32
  EXPECT_EQ(cycles({0xEEB1, 0x0AC0}), 14u);  // vsqrt.f32
  EXPECT_EQ(cycles({0xEE30, 0x0A20}), 1u);   // vadd.f32
  EXPECT_EQ(cycles({0xFB90, 0xF0F1}), 7u);   // sdiv
  EXPECT_EQ(cycles({0xB5F0}), 6u);           // push {r4-r7, lr}
}

}  // namespace
}  // namespace kinebus::emulator
