#include "vcan_tests/emulator/cpu/cortex_m4.hpp"

#include <unicorn/unicorn.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "vcan_tests/emulator/cpu/cycle_estimate.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kExcReturn = 0xFFFFFF00;
constexpr std::uint32_t kCallReturn = 0xFFFFFF01;  // where a debugger's call returns to
constexpr std::uint16_t kWfi = 0xBF30, kWfe = 0xBF20, kYield = 0xBF10;
constexpr std::uint32_t kEntryCycles = 12, kReturnCycles = 10;
constexpr std::uint32_t kControlFpca = 4, kControlSpsel = 2;
constexpr std::uint32_t kXpsrException = 0x1FF, kXpsrAligned = 1u << 9, kXpsrThumb = 1u << 24,
                        kXpsrFlags = 0xF80F0000u;
constexpr std::uint32_t kBasicFrame = 32, kFloatFrame = 104;
constexpr std::uint32_t kPeripherals = 0x40000000, kPeripheralsSize = 0x00080000;
constexpr std::uint32_t kAhb2 = 0x50000000, kAhb2Size = 0x00061000;
constexpr std::uint32_t kPrivate = 0xE0000000, kPrivateSize = 0x00100000;
constexpr std::size_t kPage = 4096;

uc_engine* engine(void* uc) {
  return static_cast<uc_engine*>(uc);
}

std::uint8_t* page_aligned(std::size_t size) {
  void* memory = std::aligned_alloc(kPage, std::max(size, kPage));
  if (memory == nullptr) throw std::bad_alloc();
  std::memset(memory, 0, size);
  return static_cast<std::uint8_t*>(memory);
}

void check(uc_err error, const char* what) {
  if (error != UC_ERR_OK) throw std::runtime_error(std::string(what) + ": " + uc_strerror(error));
}

std::uint32_t read_register(void* uc, int id) {
  std::uint32_t value = 0;
  uc_reg_read(engine(uc), id, &value);
  return value;
}

void write_register(void* uc, int id, std::uint32_t value) {
  uc_reg_write(engine(uc), id, &value);
}

template <std::size_t N>
void read_registers(void* uc, std::array<int, N>& ids, std::array<std::uint32_t, N>& values) {
  std::array<void*, N> pointers{};
  for (std::size_t i = 0; i < N; ++i) pointers[i] = &values[i];
  uc_reg_read_batch(engine(uc), ids.data(), pointers.data(), static_cast<int>(N));
}

template <std::size_t N>
void write_registers(void* uc, std::array<int, N>& ids, std::array<std::uint32_t, N>& values) {
  std::array<void*, N> pointers{};
  for (std::size_t i = 0; i < N; ++i) pointers[i] = &values[i];
  uc_reg_write_batch(engine(uc), ids.data(), pointers.data(), static_cast<int>(N));
}

std::array<int, 17> float_registers() {
  std::array<int, 17> ids{};
  for (int i = 0; i < 16; ++i) ids[static_cast<std::size_t>(i)] = UC_ARM_REG_S0 + i;
  ids[16] = UC_ARM_REG_FPSCR;
  return ids;
}

}  // namespace

struct CortexM4::Hooks {
  static void block(uc_engine*, std::uint64_t address, std::uint32_t size, void* self) {
    static_cast<CortexM4*>(self)->on_block(static_cast<std::uint32_t>(address), size);
  }
  static void intr(uc_engine*, std::uint32_t number, void* self) {
    static_cast<CortexM4*>(self)->on_intr(number);
  }
  static bool invalid(uc_engine* uc, void* self) {
    // WFE and YIELD: nothing to wait for.
    auto& cpu = *static_cast<CortexM4*>(self);
    const std::uint32_t pc = read_register(uc, UC_ARM_REG_PC) & ~1u;
    const std::uint8_t* code = cpu.host(pc, 2);
    if (code == nullptr) return false;
    const auto op = static_cast<std::uint16_t>(code[0] | code[1] << 8);
    return op == kWfe || op == kYield;
  }
  static bool flash_store(uc_engine*, uc_mem_type, std::uint64_t address, int size, std::int64_t value,
                          void* self) {
    auto& cpu = *static_cast<CortexM4*>(self);
    const auto at = static_cast<std::uint32_t>(address);
    if (at < kFlash || at >= kFlash + kFlashSize) return false;
    if (cpu.devices_.write_flash(at, static_cast<std::uint32_t>(value), size, cpu.now_) && cpu.has_run(at))
      cpu.flash_changed_ = true;
    cpu.next_stop_ = 0;
    return true;
  }
  static std::uint64_t read_low(uc_engine*, std::uint64_t offset, unsigned size, void* self) {
    return static_cast<CortexM4*>(self)->mmio_read(kPeripherals + static_cast<std::uint32_t>(offset),
                                                   static_cast<int>(size));
  }
  static void write_low(uc_engine*, std::uint64_t offset, unsigned size, std::uint64_t value, void* self) {
    static_cast<CortexM4*>(self)->mmio_write(kPeripherals + static_cast<std::uint32_t>(offset),
                                             static_cast<std::uint32_t>(value), static_cast<int>(size));
  }
  static std::uint64_t read_ahb2(uc_engine*, std::uint64_t offset, unsigned size, void* self) {
    return static_cast<CortexM4*>(self)->mmio_read(kAhb2 + static_cast<std::uint32_t>(offset),
                                                   static_cast<int>(size));
  }
  static void write_ahb2(uc_engine*, std::uint64_t offset, unsigned size, std::uint64_t value, void* self) {
    static_cast<CortexM4*>(self)->mmio_write(kAhb2 + static_cast<std::uint32_t>(offset),
                                             static_cast<std::uint32_t>(value), static_cast<int>(size));
  }
  static std::uint64_t read_private(uc_engine*, std::uint64_t offset, unsigned size, void* self) {
    auto& cpu = *static_cast<CortexM4*>(self);
    const auto at = static_cast<std::uint32_t>(offset);
    const std::uint32_t word = cpu.nvic_.read(at & ~3u, cpu.now_) >> (8 * (at & 3));
    return size == 4 ? word : word & ((1u << (8 * size)) - 1);
  }
  static void write_private(uc_engine*, std::uint64_t offset, unsigned size, std::uint64_t value,
                            void* self) {
    auto& cpu = *static_cast<CortexM4*>(self);
    const auto at = static_cast<std::uint32_t>(offset);
    if (size == 4)
      cpu.nvic_.write(at, static_cast<std::uint32_t>(value), cpu.now_);
    else
      cpu.nvic_.write_part(at, static_cast<std::uint32_t>(value), static_cast<int>(size), cpu.now_);
    cpu.next_stop_ = 0;
  }
};

CortexM4::CortexM4(Devices& devices)
    : devices_(devices), flash_(kFlashSize + kPage, 0xFF), block_costs_(kFlashSize / 2) {
  uc_engine* uc = nullptr;
  check(uc_open(UC_ARCH_ARM, UC_MODE_THUMB, &uc), "uc_open");
  uc_ = uc;
  check(uc_ctl_set_cpu_model(uc, UC_CPU_ARM_CORTEX_M4), "cpu model");
  sram_ = page_aligned(kSramSize);
  ccm_ = page_aligned(kCcmSize);
  system_memory_ = page_aligned(kSystemMemorySize);
  system_boot_ = page_aligned(kSystemBootSize);
  constexpr std::array<std::uint32_t, 3> kLoop{kSram + 0x2000, kSystemBoot + 9,
                                               0xE7FEE7FE};  // stack, entry, b .
  std::memcpy(system_boot_, kLoop.data(), sizeof kLoop);
  check(uc_mem_map_ptr(uc, kSram, kSramSize, UC_PROT_ALL, sram_), "SRAM");
  check(uc_mem_map_ptr(uc, kCcm, kCcmSize, UC_PROT_READ | UC_PROT_WRITE, ccm_), "CCM");
  check(uc_mem_map_ptr(uc, kSystemMemory, kSystemMemorySize, UC_PROT_READ, system_memory_), "system memory");
  check(uc_mem_map_ptr(uc, kSystemBoot, kSystemBootSize, UC_PROT_READ | UC_PROT_EXEC, system_boot_),
        "system boot loader");
  check(uc_mem_map_ptr(uc, kFlash, kFlashSize, UC_PROT_READ | UC_PROT_EXEC, flash_.data()), "flash");
  check(uc_mmio_map(uc, kPeripherals, kPeripheralsSize, &Hooks::read_low, this, &Hooks::write_low, this),
        "APB, AHB1");
  check(uc_mmio_map(uc, kAhb2, kAhb2Size, &Hooks::read_ahb2, this, &Hooks::write_ahb2, this), "AHB2");
  check(uc_mmio_map(uc, kPrivate, kPrivateSize, &Hooks::read_private, this, &Hooks::write_private, this),
        "PPB");
  const auto add = [&](int type, auto* callback) {
    uc_hook hook = 0;
    check(uc_hook_add(uc, &hook, type, reinterpret_cast<void*>(callback), this, 1, 0), "hook");
  };
  add(UC_HOOK_BLOCK, &Hooks::block);
  add(UC_HOOK_INTR, &Hooks::intr);
  add(UC_HOOK_INSN_INVALID, &Hooks::invalid);
  add(UC_HOOK_MEM_WRITE_PROT, &Hooks::flash_store);
}

CortexM4::~CortexM4() {
  uc_close(engine(uc_));
  std::free(sram_);
  std::free(ccm_);
  std::free(system_memory_);
  std::free(system_boot_);
}

void CortexM4::load(const ElfImage& image) {
  for (const ElfImage::Piece& piece : image.pieces) {
    std::uint8_t* to = host(piece.address, static_cast<std::uint32_t>(piece.bytes.size()));
    if (to == nullptr) throw std::runtime_error("image has a piece outside flash and RAM");
    std::copy(piece.bytes.begin(), piece.bytes.end(), to);
  }
  flash_changed_ = true;
}

void CortexM4::reset(std::uint32_t vectors) {
  nvic_.reset(vectors);
  uc_ctl_remove_cache(engine(uc_), kSram, kSram + kSramSize);
  running_.clear();
  asleep_ = stop_asked_ = false;
  stalled_until_ = 0;
  pending_since_ = kNever;
  skip_block_ = 1;
  write_register(uc_, UC_ARM_REG_IPSR, 0);
  write_register(uc_, UC_ARM_REG_PRIMASK, 0);
  write_register(uc_, UC_ARM_REG_BASEPRI, 0);
  write_register(uc_, UC_ARM_REG_FAULTMASK, 0);
  write_register(uc_, UC_ARM_REG_CONTROL, 0);
  write_register(uc_, UC_ARM_REG_LR, 0xFFFFFFFF);
  write_register(uc_, UC_ARM_REG_SP, peek(vectors));
  pc_ = peek(vectors + 4) & ~1u;
}

void CortexM4::start_profile() {
  profile_.assign(kFlashSize / 2, 0);
}

std::uint64_t CortexM4::profiled_cycles(std::uint32_t begin, std::uint32_t end) const {
  std::uint64_t sum = 0;
  for (std::uint32_t at = begin; at < end && (at - kFlash) / 2 < profile_.size(); at += 2)
    sum += profile_[(at - kFlash) / 2];
  return sum;
}

std::uint8_t* CortexM4::host(std::uint32_t address, std::uint32_t size) {
  const auto within = [&](std::uint32_t base, std::uint32_t length) {
    return address >= base && size <= length && address - base <= length - size;
  };
  if (within(kSram, kSramSize)) return sram_ + (address - kSram);
  if (within(kCcm, kCcmSize)) return ccm_ + (address - kCcm);
  if (within(kFlash, kFlashSize)) return flash_.data() + (address - kFlash);
  if (within(kSystemMemory, kSystemMemorySize)) return system_memory_ + (address - kSystemMemory);
  return nullptr;
}

std::uint32_t CortexM4::peek(std::uint32_t address) {
  const std::uint8_t* at = host(address, 4);
  if (at == nullptr) throw std::out_of_range("no memory there");
  std::uint32_t value = 0;
  std::memcpy(&value, at, 4);
  return value;
}

void CortexM4::poke(std::uint32_t address, std::uint32_t value) {
  std::uint8_t* at = host(address, 4);
  if (at == nullptr) throw std::out_of_range("no memory there");
  std::memcpy(at, &value, 4);
}

std::uint32_t CortexM4::mmio_read(std::uint32_t address, int size) {
  return devices_.read(address, size, now_);
}

void CortexM4::mmio_write(std::uint32_t address, std::uint32_t value, int size) {
  devices_.write(address, value, size, now_);
  next_stop_ = 0;  // what comes next may have changed: looked at after this block
}

std::uint32_t CortexM4::code_cost(std::uint32_t address, std::uint32_t size) {
  const std::uint8_t* code = host(address, size);
  if (code == nullptr) return 1u << 16 | 1;
  std::array<std::uint16_t, 1024> half_words{};
  const std::size_t count = std::min<std::size_t>(size / 2, half_words.size());
  std::memcpy(half_words.data(), code, count * 2);
  const CodeCost cost = estimate_cost(std::span(half_words).first(count));
  return cost.instructions << 16 | cost.cycles;
}

void CortexM4::note_code(std::uint32_t address, std::uint32_t size) {
  for (std::uint32_t page = (address - kFlash) / kCodePage; page <= (address - kFlash + size - 1) / kCodePage;
       ++page)
    if (page < code_pages_.size()) code_pages_.set(page);
}

void CortexM4::count(std::uint32_t instructions, std::uint32_t cycles) {
  instructions_ += instructions;
  now_ += cycles;
  if (!running_.empty()) {
    running_.back().instructions += instructions;
    running_.back().cycles += cycles;
  }
}

void CortexM4::on_block(std::uint32_t address, std::uint32_t size) {
  if (call_ != Call::kNone) {
    note_code(address, size);
    if (++call_blocks_ > 1'000'000) uc_emu_stop(engine(uc_));
    return;
  }
  std::uint32_t cost = 0;
  if (address == skip_block_) {
    skip_block_ = 1;
  } else {
    const std::uint32_t index = (address - kFlash) / 2;
    if (index < block_costs_.size()) {
      cost = block_costs_[index];
      if (cost == 0) {
        cost = block_costs_[index] = code_cost(address, size);
        note_code(address, size);
      }
    } else {
      cost = code_cost(address, size);  // in RAM: may change, and is rare
    }
    count(cost >> 16, cost & 0xFFFF);
    if (!profile_.empty() && index < profile_.size()) profile_[index] += cost & 0xFFFF;
  }
  if (now_ < next_stop_) return;

  if (stalled_until_ > now_ && address - kFlash < kFlashSize) now_ = stalled_until_;
  serve_time();
  if (stop_asked_) limit_ = now_;
  if (!stop_asked_ && nvic_.any_pending() && take_exception(address)) {
    // The block has not run: it is counted when it does.
    instructions_ -= cost >> 16;
    now_ -= cost & 0xFFFF;
    if (running_.size() > 1) {
      running_[running_.size() - 2].instructions -= cost >> 16;
      running_[running_.size() - 2].cycles -= cost & 0xFFFF;
    }
    return;
  }
  if (now_ >= limit_ || flash_changed_ || !failure_.empty()) {
    pc_ = address;
    skip_block_ = address;
    stopped_ = true;
    uc_emu_stop(engine(uc_));
  }
}

void CortexM4::serve_time() {
  const Cycle due = std::min({now_, devices_.next_event(), nvic_.next_event()});
  devices_.advance(now_);
  nvic_.advance(now_);
  if (nvic_.any_pending()) {
    if (pending_since_ == kNever) pending_since_ = due;
    next_stop_ = 0;  // masked: looked at before every block
  } else {
    pending_since_ = kNever;
    next_stop_ = std::min({limit_, devices_.next_event(), nvic_.next_event()});
  }
}

bool CortexM4::take_exception(std::uint32_t return_address) {
  if (nvic_.next_exception({}) == kThread) return false;
  static std::array<int, 3> ids{UC_ARM_REG_PRIMASK, UC_ARM_REG_BASEPRI, UC_ARM_REG_FAULTMASK};
  std::array<std::uint32_t, 3> masks{};
  read_registers(uc_, ids, masks);
  const int exception = nvic_.next_exception({masks[0], masks[1], masks[2]});
  if (exception == kThread) return false;
  enter(exception, return_address);
  return true;
}

void CortexM4::begin_count(int exception) {
  running_.push_back({exception, 0, kEntryCycles});
  ExceptionCost& cost = costs_[static_cast<std::size_t>(exception)];
  if (pending_since_ != kNever) cost.worst_latency = std::max(cost.worst_latency, now_ - pending_since_);
}

void CortexM4::end_count() {
  const Running done = running_.back();
  running_.pop_back();
  ExceptionCost& cost = costs_[static_cast<std::size_t>(done.exception)];
  cost.calls += 1;
  cost.instructions += done.instructions;
  cost.cycles += done.cycles;
  cost.worst_instructions = std::max(cost.worst_instructions, static_cast<std::uint32_t>(done.instructions));
  cost.worst_cycles = std::max(cost.worst_cycles, static_cast<std::uint32_t>(done.cycles));
}

void CortexM4::enter(int exception, std::uint32_t return_address) {
  static std::array<int, 9> ids{UC_ARM_REG_R0, UC_ARM_REG_R1,      UC_ARM_REG_R2,
                                UC_ARM_REG_R3, UC_ARM_REG_R12,     UC_ARM_REG_LR,
                                UC_ARM_REG_SP, UC_ARM_REG_CONTROL, UC_ARM_REG_XPSR};
  std::array<std::uint32_t, 9> values{};
  read_registers(uc_, ids, values);
  const std::uint32_t control = values[7];
  if ((control & kControlSpsel) != 0) failure_ = "the process stack is not modelled";
  const bool with_float = (control & kControlFpca) != 0;
  if (with_float && !nvic_.fpu_enabled()) failure_ = "floating point used, but CPACR does not enable it";

  std::uint32_t sp = values[6];
  const std::uint32_t aligned = (sp & 4) != 0 ? kXpsrAligned : 0;
  sp = (sp - (with_float ? kFloatFrame : kBasicFrame)) & ~7u;
  lowest_stack_ = std::min(lowest_stack_, sp);
  std::uint8_t* frame = host(sp, with_float ? kFloatFrame : kBasicFrame);
  if (frame == nullptr) {
    failure_ = "stack pointer outside RAM at exception entry";
    return;
  }
  // Flags and the state of an IT block in progress (blocks of the emulation end in the middle of one at page
  // ends).
  const std::uint32_t xpsr = (values[8] & ~(kXpsrException | kXpsrAligned)) | kXpsrThumb | aligned |
                             static_cast<std::uint32_t>(nvic_.active_exception());
  std::array<std::uint32_t, 8> words{values[0], values[1], values[2],      values[3],
                                     values[4], values[5], return_address, xpsr};
  std::memcpy(frame, words.data(), kBasicFrame);
  if (with_float) {
    static std::array<int, 17> float_ids = float_registers();
    std::array<std::uint32_t, 17> floats{};
    read_registers(uc_, float_ids, floats);
    std::memcpy(frame + kBasicFrame, floats.data(), sizeof floats);
  }
  const std::uint32_t exc_return = 0xFFFFFFE1u | (with_float ? 0 : 0x10u) | (nvic_.depth() == 0 ? 0x8u : 0);
  begin_count(exception);
  nvic_.enter(exception);
  pending_since_ = nvic_.any_pending() ? now_ : kNever;
  now_ += kEntryCycles;

  const std::uint8_t* vector = host(nvic_.vector_table() + 4 * static_cast<std::uint32_t>(exception), 4);
  std::uint32_t handler = 0;
  if (vector != nullptr) std::memcpy(&handler, vector, 4);
  if ((handler & 1) == 0) failure_ = "no handler for exception " + std::to_string(exception);
  static std::array<int, 5> to{UC_ARM_REG_SP, UC_ARM_REG_LR, UC_ARM_REG_CONTROL, UC_ARM_REG_XPSR,
                               UC_ARM_REG_PC};
  std::array<std::uint32_t, 5> set{
      sp, exc_return, control & ~kControlFpca,
      (values[8] & kXpsrFlags) | kXpsrThumb | static_cast<std::uint32_t>(exception), handler | 1};
  write_registers(uc_, to, set);
  pc_ = handler & ~1u;
  next_stop_ = 0;
}

void CortexM4::return_from_exception(std::uint32_t exc_return) {
  if (nvic_.depth() == 0) {
    failure_ = "exception return outside an exception";
    return;
  }
  const int exception = nvic_.active_exception();
  nvic_.leave(exception);
  count(0, kReturnCycles);
  end_count();

  const bool with_float = (exc_return & 0x10) == 0;
  std::uint32_t sp = read_register(uc_, UC_ARM_REG_SP);
  const std::uint32_t size = with_float ? kFloatFrame : kBasicFrame;
  const std::uint8_t* frame = host(sp, size);
  if (frame == nullptr) {
    failure_ = "stack pointer outside RAM at exception return";
    return;
  }
  std::array<std::uint32_t, 8> words{};
  std::memcpy(words.data(), frame, kBasicFrame);
  if (with_float) {
    static std::array<int, 17> float_ids = float_registers();
    std::array<std::uint32_t, 17> floats{};
    std::memcpy(floats.data(), frame + kBasicFrame, sizeof floats);
    write_registers(uc_, float_ids, floats);
  }
  const std::uint32_t xpsr = words[7];
  sp += size;
  if ((xpsr & kXpsrAligned) != 0) sp |= 4;
  std::uint32_t control = read_register(uc_, UC_ARM_REG_CONTROL);
  control = with_float ? control | kControlFpca : control & ~kControlFpca;
  if ((xpsr & kXpsrException) != static_cast<std::uint32_t>(nvic_.active_exception()))
    failure_ = "exception return to a wrong frame";

  static std::array<int, 10> ids{UC_ARM_REG_R0,   UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3,
                                 UC_ARM_REG_R12,  UC_ARM_REG_LR, UC_ARM_REG_SP, UC_ARM_REG_CONTROL,
                                 UC_ARM_REG_XPSR, UC_ARM_REG_PC};
  std::array<std::uint32_t, 10> set{
      words[0],    words[1], words[2], words[3], words[4], words[5], sp, control, xpsr & ~kXpsrAligned,
      words[6] | 1};
  write_registers(uc_, ids, set);
  pc_ = words[6] & ~1u;
  next_stop_ = 0;
}

void CortexM4::on_intr(std::uint32_t number) {
  const std::uint32_t pc = read_register(uc_, UC_ARM_REG_PC);
  if (call_ != Call::kNone) {
    if ((number == 3 || number == 8) && (pc | 1) == kCallReturn) call_ = Call::kDone;
    uc_emu_stop(engine(uc_));
    return;
  }
  if ((number == 3 || number == 8) && (pc | 1) >= kExcReturn) {
    return_from_exception(pc | 1);
    return;
  }
  if (number == 2) {
    nvic_.pend(kSvCall);
    next_stop_ = 0;
    return;
  }
  failure_ =
      number == 7 ? "breakpoint instruction" : "exception " + std::to_string(number) + " of the processor";
  pc_ = pc & ~1u;
  stopped_ = true;
  uc_emu_stop(engine(uc_));
}

bool CortexM4::wakes() const {
  // WFI goes on for whatever would preempt if PRIMASK were clear.
  return nvic_.next_exception({0, read_register(uc_, UC_ARM_REG_BASEPRI), 0}) != kThread;
}

void CortexM4::run(Cycle limit) {
  limit_ = limit;
  while (now_ < limit_ && !stop_asked_) {
    if (asleep_) {
      devices_.advance(now_);
      nvic_.advance(now_);
      if (!wakes()) {
        const Cycle until = std::clamp(std::min(devices_.next_event(), nvic_.next_event()), now_, limit_);
        idle_ += until - now_;
        now_ = until;
        devices_.advance(now_);
        nvic_.advance(now_);
        if (stop_asked_ || !wakes()) continue;
      }
      asleep_ = false;
      pending_since_ = now_;
      take_exception(pc_);
    }
    if (flash_changed_) {
      flash_changed_ = false;
      std::fill(block_costs_.begin(), block_costs_.end(), 0u);
      code_pages_.reset();
      uc_ctl_remove_cache(engine(uc_), kFlash, kFlash + kFlashSize);
    }
    stopped_ = false;
    next_stop_ = 0;
    const uc_err error = uc_emu_start(engine(uc_), pc_ | 1, 0, 0, 0);
    if (!failure_.empty()) fail(failure_);
    if (error != UC_ERR_OK) {
      pc_ = read_register(uc_, UC_ARM_REG_PC) & ~1u;
      fail(uc_strerror(error));
    }
    if (stopped_) continue;
    pc_ = read_register(uc_, UC_ARM_REG_PC) & ~1u;
    skip_block_ = 1;
    const std::uint8_t* code = host(pc_ - 2, 2);
    if (code == nullptr || static_cast<std::uint16_t>(code[0] | code[1] << 8) != kWfi)
      fail("unexplained stop");
    asleep_ = true;
  }
  stop_asked_ = false;
}

std::optional<std::uint64_t> CortexM4::call(std::uint32_t function, std::uint64_t argument) {
  uc_context* saved = nullptr;
  check(uc_context_alloc(engine(uc_), &saved), "context");
  check(uc_context_save(engine(uc_), saved), "context");
  // Below a frame that the interrupted code may use under its stack pointer.
  const std::uint32_t sp = (read_register(uc_, UC_ARM_REG_SP) - 256) & ~7u;
  write_register(uc_, UC_ARM_REG_SP, sp);
  write_register(uc_, UC_ARM_REG_R0, static_cast<std::uint32_t>(argument));
  write_register(uc_, UC_ARM_REG_R1, static_cast<std::uint32_t>(argument >> 32));
  write_register(uc_, UC_ARM_REG_LR, kCallReturn);
  write_register(uc_, UC_ARM_REG_ITSTATE, 0);
  call_ = Call::kRunning;
  call_blocks_ = 0;
  uc_emu_start(engine(uc_), function | 1, 0, 0, 0);
  const bool good = call_ == Call::kDone;
  call_ = Call::kNone;
  const std::uint64_t result =
      std::uint64_t{read_register(uc_, UC_ARM_REG_R1)} << 32 | read_register(uc_, UC_ARM_REG_R0);
  check(uc_context_restore(engine(uc_), saved), "context");
  uc_context_free(saved);
  if (!good) return std::nullopt;
  return result;
}

void CortexM4::fail(const std::string& what) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), " (pc 0x%08x, lr 0x%08x, sp 0x%08x, exception %d, cycle %llu)", pc_,
                read_register(uc_, UC_ARM_REG_LR), read_register(uc_, UC_ARM_REG_SP),
                nvic_.active_exception(), static_cast<unsigned long long>(now_));
  failure_.clear();
  throw std::runtime_error("emulated program: " + what + text.data());
}

}  // namespace kinebus::emulator
