#include "vcan_tests/emulator/cpu/cortex_m4.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "vcan_tests/emulator/cpu/cycle_estimate.hpp"
#include "vcan_tests/emulator/cpu/unicorn_registers.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint16_t kWfi = 0xBF30, kWfe = 0xBF20, kYield = 0xBF10;
constexpr std::uint32_t kPeripherals = 0x40000000, kPeripheralsSize = 0x00080000;
constexpr std::uint32_t kAhb2 = 0x50000000, kAhb2Size = 0x00061000;
constexpr std::uint32_t kPrivate = 0xE0000000, kPrivateSize = 0x00100000;
constexpr std::size_t kPage = 4096;

std::uint8_t* page_aligned(std::size_t size) {
  void* memory = std::aligned_alloc(kPage, std::max(size, kPage));
  if (memory == nullptr) throw std::bad_alloc();
  std::memset(memory, 0, size);
  return static_cast<std::uint8_t*>(memory);
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
    const bool once = at >= kOneTimeMemory && at < kOneTimeMemory + kOneTimeMemorySize && !cpu.facts_.small;
    if (!once && (at < kFlash || at >= kFlash + kFlashSize)) return false;
    if (once)
      static_cast<void>(cpu.devices_.write_flash(at, static_cast<std::uint32_t>(value), size, cpu.now_));
    else if (cpu.devices_.write_flash(at, static_cast<std::uint32_t>(value), size, cpu.now_) &&
             cpu.has_run(at))
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

CortexM4::CortexM4(Devices& devices, const CoreFacts& facts)
    : devices_(devices), facts_(facts), flash_(kFlashSize + kPage, 0xFF), block_costs_(kFlashSize / 2) {
  uc_engine* uc = nullptr;
  check(uc_open(UC_ARCH_ARM, UC_MODE_THUMB, &uc), "uc_open");
  uc_ = uc;
  // Also for the Cortex-M0+: Unicorn's Cortex-M0 does not return from exceptions. code_cost() looks that only
  // instructions of the smaller core run.
  check(uc_ctl_set_cpu_model(uc, UC_CPU_ARM_CORTEX_M4), "cpu model");
  nvic_.set_small(facts.small);
  sram_ = page_aligned(kSramSize);
  ccm_ = page_aligned(kCcmSize);
  system_memory_ = page_aligned(kSystemMemorySize);
  system_boot_ = page_aligned(kSystemBootSize);
  constexpr std::array<std::uint32_t, 3> kLoop{kSram + 0x2000, kSystemBoot + 9,
                                               0xE7FEE7FE};  // stack, entry, b .
  std::memcpy(system_boot_, kLoop.data(), sizeof kLoop);
  check(uc_mem_map_ptr(uc, kSram, kSramSize, UC_PROT_ALL, sram_), "SRAM");
  if (facts.core_coupled_memory)
    check(uc_mem_map_ptr(uc, kCcm, kCcmSize, UC_PROT_READ | UC_PROT_WRITE, ccm_), "CCM");
  check(uc_mem_map_ptr(uc, facts.system_memory, kSystemMemorySize, UC_PROT_READ, system_memory_),
        "system memory");
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
  watch_at_ = watched_function_;
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

std::uint8_t* CortexM4::host(std::uint32_t address, std::uint32_t size) {
  const auto within = [&](std::uint32_t base, std::uint32_t length) {
    return address >= base && size <= length && address - base <= length - size;
  };
  if (within(kSram, kSramSize)) return sram_ + (address - kSram);
  if (within(kCcm, kCcmSize)) return ccm_ + (address - kCcm);
  if (within(kFlash, kFlashSize)) return flash_.data() + (address - kFlash);
  if (within(facts_.system_memory, kSystemMemorySize))
    return system_memory_ + (address - facts_.system_memory);
  return nullptr;
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
  const auto words = std::span(half_words).first(count);
  const CodeCost cost =
      facts_.small ? estimate_small_cost(words, address - kFlash < kFlashSize) : estimate_cost(words);
  if (facts_.small && !small_core_runs(words) && failure_.empty()) {
    pc_ = address;
    failure_ = "an instruction that a Cortex-M0+ does not have";
    next_stop_ = 0;
  }
  return cost.instructions << 16 | cost.cycles;
}

void CortexM4::note_code(std::uint32_t address, std::uint32_t size) {
  for (std::uint32_t page = (address - kFlash) / kCodePage; page <= (address - kFlash + size - 1) / kCodePage;
       ++page)
    if (page < code_pages_.size()) code_pages_.set(page);
}

Cycle CortexM4::elapse(std::uint32_t clocks) {
  const Cycle parts = clocks * facts_.cycles + rest_;
  rest_ = parts % facts_.clocks;
  now_ += parts / facts_.clocks;
  return parts / facts_.clocks;
}

Cycle CortexM4::count(std::uint32_t instructions, std::uint32_t cycles) {
  instructions_ += instructions;
  const Cycle elapsed = elapse(cycles);
  if (!running_.empty()) {
    running_.back().instructions += instructions;
    running_.back().cycles += cycles;
  } else {
    own_cycles_ += cycles;
  }
  return elapsed;
}

void CortexM4::on_block(std::uint32_t address, std::uint32_t size) {
  if (call_ != Call::kNone) {
    note_code(address, size);
    if (++call_blocks_ > 1'000'000) uc_emu_stop(engine(uc_));
    return;
  }
  std::uint32_t cost = 0;
  Cycle elapsed = 0;
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
    elapsed = count(cost >> 16, cost & 0xFFFF);
    if (!profile_.empty() && index < profile_.size()) profile_[index] += cost & 0xFFFF;
    if (address == watch_at_) on_watched();
  }
  if (now_ < next_stop_) return;

  if (stalled_until_ > now_ && address - kFlash < kFlashSize) now_ = stalled_until_;
  serve_time();
  if (stop_asked_) limit_ = now_;
  if (!stop_asked_ && nvic_.any_pending() && take_exception(address)) {
    // The block has not run: it is counted when it does.
    instructions_ -= cost >> 16;
    now_ -= elapsed;
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
      pass_began_ = now_;
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
    longest_pass_ = std::max(longest_pass_, now_ - pass_began_);
  }
  stop_asked_ = false;
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
