// Runs on the emulated processor: exercises what a Cortex-M4 does around its instructions and leaves what it
// saw in `results`, which core_test.cpp reads.

#include <cstdint>

namespace {

using u32 = std::uint32_t;
volatile u32& reg(u32 address) {
  return *reinterpret_cast<volatile u32*>(address);
}
constexpr u32 kIser = 0xE000E100, kIspr = 0xE000E200, kIpr = 0xE000E400, kIcsr = 0xE000ED04,
              kShpr3 = 0xE000ED20;

void enable(int irq) {
  reg(kIser) = 1u << irq;
}
void pend(int irq) {
  reg(kIspr) = 1u << irq;
  asm volatile("dsb\n isb");
}
void priority(int irq, std::uint8_t value) {
  *reinterpret_cast<volatile std::uint8_t*>(kIpr + static_cast<u32>(irq)) = value;
}

volatile u32 order[32];
volatile u32 order_count;
void note(u32 what) {
  const u32 at = order_count;
  order[at] = what;
  order_count = at + 1;
}

volatile u32 ticks;
volatile float float_sum;

}  // namespace

extern "C" {

struct Results {
  u32 done, nesting_ok, tail_chain_ok, basepri_ok, primask_ok, float_ok, it_ok, wfi_ok, svc_ok, pendsv_ok,
      cyccnt_ok, ipsr_ok, alignment_ok, split_it_ok, systick_count, ldm_ok;
};
Results results;
u32 seed_value;

void isr_low() {  // irq 0, lowest priority
  note(10);
  pend(1);
  note(11);
}
void isr_high() {  // irq 1: preempts irq 0
  note(20);
}
void isr_chain() {  // irq 2 and 3: same priority
  u32 ipsr;
  asm volatile("mrs %0, ipsr" : "=r"(ipsr));
  note(100 + ipsr);
}
void isr_float() {  // irq 4: uses the floating point registers
  float a = 1.5F;
  for (int i = 0; i < 3; ++i) a = a * 1.25F + 0.5F;
  float_sum = float_sum + a;
}
void isr_svc() {
  note(300);
}
void isr_pendsv() {
  note(400);
}
void isr_systick() {
  ticks = ticks + 1;
  // Disturbs every register that the frame must restore.
  asm volatile(
      "mov r0, #0\n mov r1, #1\n mov r2, #2\n mov r3, #3\n mov r12, #12\n cmp r0, r1\n vmov s0, r1\n vmov "
      "s15, r2" ::
          : "r0", "r1", "r2", "r3", "r12", "cc", "s0", "s15");
}
void isr_fault() {
  for (;;) asm volatile("bkpt");
}
void guest_main();

__attribute__((section(".vectors"), used)) void* const vectors[16 + 8] = {
    reinterpret_cast<void*>(0x20020000),
    reinterpret_cast<void*>(guest_main),
    reinterpret_cast<void*>(isr_fault),
    reinterpret_cast<void*>(isr_fault),
    reinterpret_cast<void*>(isr_fault),
    reinterpret_cast<void*>(isr_fault),
    reinterpret_cast<void*>(isr_fault),
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    reinterpret_cast<void*>(isr_svc),
    nullptr,
    nullptr,
    reinterpret_cast<void*>(isr_pendsv),
    reinterpret_cast<void*>(isr_systick),
    reinterpret_cast<void*>(isr_low),
    reinterpret_cast<void*>(isr_high),
    reinterpret_cast<void*>(isr_chain),
    reinterpret_cast<void*>(isr_chain),
    reinterpret_cast<void*>(isr_float),
    reinterpret_cast<void*>(isr_chain),
    nullptr,
    nullptr};

// An IT block that lies across a page's end, where the emulation cuts its blocks: the interrupt comes within.
// Returns 0x0B for a < b, 0x30 else, and flags that live across a jump.
u32 split_it(u32 a, u32 b);
asm(R"(
  .section .text.split, "ax"
  .balign 4096
  .space 4088
  .thumb_func
  .global split_it
split_it:
  mov r3, #0
  cmp r0, r1
  ittee lo
  addlo r3, #1
  addlo r3, #10
  addhs r3, #0x10
  addhs r3, #0x20
  cmp r0, r1
  b 1f
  nop
1: blo 2f
  b 3f
2: mov r0, r3
  bx lr
3: cmp r3, #0x30
  mov r0, r3
  bx lr
  .text
)");
void guest_main() {
  for (u32 i = 0; i < sizeof(Results) / 4; ++i) reinterpret_cast<volatile u32*>(&results)[i] = 0;
  order_count = 0;
  ticks = 0;
  float_sum = 0;
  reg(0xE000ED88) |= 0x00F00000u;  // CPACR: FPU on
  reg(0xE000EDFC) |= 1u << 24;
  reg(0xE0001000) |= 1;  // DWT cycle counter
  asm volatile("dsb\n isb");

  priority(0, 0xE0);
  priority(1, 0x20);
  priority(2, 0x80);
  priority(3, 0x80);
  priority(4, 0x40);
  for (int irq = 0; irq < 6; ++irq) enable(irq);

  // Nesting: the high one runs inside the low one.
  pend(0);
  results.nesting_ok = order_count == 3 && order[0] == 10 && order[1] == 20 && order[2] == 11;

  // Two of one priority, pended together: by number, one after the other.
  order_count = 0;
  asm volatile("cpsid i");
  reg(kIspr) = 1u << 3 | 1u << 2;
  results.primask_ok = order_count == 0;
  asm volatile("cpsie i\n isb");
  results.tail_chain_ok = order_count == 2 && order[0] == 118 && order[1] == 119;

  // BASEPRI holds back its level and what is less urgent, not more.
  order_count = 0;
  asm volatile("msr basepri, %0" ::"r"(0x80));
  pend(2);
  const bool held = order_count == 0;
  pend(1);
  const bool passed = order_count == 1 && order[0] == 20;
  asm volatile("msr basepri, %0\n isb" ::"r"(0));
  results.basepri_ok = held && passed && order_count == 2 && order[1] == 118;

  // Software exceptions.
  order_count = 0;
  asm volatile("svc 0");
  results.svc_ok = order_count == 1 && order[0] == 300;
  reg(kShpr3) = 0xF0u << 16 | 0x10u << 24;
  reg(kIcsr) = 1u << 28;
  asm volatile("dsb\n isb");
  results.pendsv_ok = order_count == 2 && order[1] == 400;
  u32 ipsr = 99;
  asm volatile("mrs %0, ipsr" : "=r"(ipsr));
  results.ipsr_ok = ipsr == 0;

  // SysTick every 500 cycles through arithmetic, IT blocks and floating point: nothing may differ.
  const u32 cycles_before = reg(0xE0001004);
  reg(0xE000E014) = 499;
  reg(0xE000E018) = 0;
  reg(0xE000E010) = 7;
  u32 a = seed_value, expected = seed_value;
  float f = 0.5F;
  bool it_good = true, float_good = true;
  for (u32 i = 0; i < 20000; ++i) {
    u32 low = 0, high = 0;
    asm volatile(
        "cmp %2, %3\n"
        "ittee lt\n"
        "addlt %0, %0, #1\n"
        "addlt %1, %1, #2\n"
        "addge %0, %0, #3\n"
        "addge %1, %1, #4\n"
        : "+r"(low), "+r"(high)
        : "r"(static_cast<int>(i & 7)), "r"(4)
        : "cc");
    if ((i & 7) < 4 ? !(low == 1 && high == 2) : !(low == 3 && high == 4)) it_good = false;
    a = a * 1664525u + 1013904223u;
    expected = expected * 1664525u + 1013904223u;
    f = f * 1.0001F + 0.25F;
    if (i % 100 == 0) pend(4);
    if (i % 1000 == 999) {
      float g = 0.5F;
      for (u32 k = 0; k <= i; ++k) {
        g = g * 1.0001F + 0.25F;
        asm volatile("" : "+t"(g));
      }
      if (g != f) float_good = false;
    }
    asm volatile("" : "+r"(a), "+r"(expected));
  }
  bool split_good = true;
  for (u32 i = 0; i < 20000; ++i) {
    const u32 x = i & 3, y = i >> 2 & 3;
    if (split_it(x, y) != (x < y ? 0x0Bu : 0x30u)) split_good = false;
  }
  results.split_it_ok = split_good;
  results.it_ok = it_good && a == expected;
  results.float_ok = float_good && float_sum > 0;
  reg(0xE000E010) = 0;
  results.systick_count = ticks;
  const u32 cycles = reg(0xE0001004) - cycles_before;
  results.cyccnt_ok = cycles / 500 >= ticks - 1 && cycles / 500 <= ticks + 1;

  // WFI sleeps until the tick; its handler has run when the program goes on.
  ticks = 0;
  reg(0xE000E014) = 99'999;
  reg(0xE000E018) = 0;
  reg(0xE000E010) = 7;
  for (int i = 0; i < 10; ++i) asm volatile("wfi");
  results.wfi_ok = ticks == 10;
  // With PRIMASK set WFI still wakes, and the handler waits.
  asm volatile("cpsid i");
  asm volatile("wfi");
  results.wfi_ok = results.wfi_ok && ticks == 10;
  asm volatile("cpsie i\n isb");
  results.wfi_ok = results.wfi_ok && ticks == 11;
  reg(0xE000E010) = 0;

  // A stack that is not a multiple of 8 is aligned for the frame, and restored.
  u32 sp_before = 0, sp_after = 0;
  asm volatile(
      "push {r4}\n"
      "mov %0, sp\n"
      "str %2, [%3]\n"
      "dsb\n isb\n"
      "mov %1, sp\n"
      "pop {r4}\n"
      : "=&r"(sp_before), "=&r"(sp_after)
      : "r"(1u << 5), "r"(kIspr)
      : "memory");
  results.alignment_ok = sp_before == sp_after;
  results.done = 0x600D;
  for (;;) asm volatile("wfi");
}

}  // extern "C"
