#include "vcan_tests/emulator/cost_report.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

namespace kinebus::emulator {
namespace {

constexpr double kControlPeriodCycles = 8400;  // 20 kHz

std::string readable(const std::string& name) {
  int status = 0;
  char* text = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status);
  std::string out = status == 0 && text != nullptr ? text : name;
  std::free(text);
  if (const auto arguments = out.find('(');
      arguments != std::string::npos && arguments > 0 && !out.starts_with("("))
    out.resize(arguments);
  return out;
}

std::string name_of(int exception) {
  static const std::map<int, const char*> kNames{
      {kSysTick, "SysTick"},       {16 + 6, "EXTI0 switch"},  {16 + 7, "EXTI1 switch"},
      {16 + 9, "EXTI3 switch"},    {16 + 10, "EXTI4 switch"}, {16 + 18, "ADC control"},
      {16 + 19, "CAN1 transmit"},  {16 + 20, "CAN1 receive"}, {16 + 22, "CAN1 state"},
      {16 + 23, "EXTI9-5 switch"}, {16 + 24, "TIM1 break"},   {16 + 37, "USART1"},
      {16 + 40, "EXTI15-10"},      {16 + 43, "TIM8 break"},   {16 + 77, "USB"}};
  const auto found = kNames.find(exception);
  return found == kNames.end() ? fmt::format("exception {}", exception) : found->second;
}

}  // namespace

std::string cost_table(const Board& board, Cycle began, Cycle idle_before) {
  const CortexM4& cpu = board.cpu();
  const auto span = static_cast<double>(std::max<Cycle>(cpu.now() - began, 1));
  std::string out = fmt::format("{:<16}{:>9}{:>8}{:>8}{:>9}{:>8}{:>9}{:>10}\n", "interrupt", "calls",
                                "instr.", "worst", "cycles", "worst", "CPU %", "late us");
  for (int e = 1; e < Nvic::kExceptions; ++e) {
    const ExceptionCost& cost = cpu.cost(e);
    if (cost.calls == 0) continue;
    const auto calls = static_cast<double>(cost.calls);
    out += fmt::format("{:<16}{:>9}{:>8.0f}{:>8}{:>9.0f}{:>8}{:>9.2f}{:>10.2f}\n", name_of(e), cost.calls,
                       static_cast<double>(cost.instructions) / calls, cost.worst_instructions,
                       static_cast<double>(cost.cycles) / calls, cost.worst_cycles,
                       100.0 * static_cast<double>(cost.cycles) / span,
                       static_cast<double>(cost.worst_latency) / 168);
  }
  const ExceptionCost& control = cpu.cost(kFirstInterrupt + AdcBlock::kIrq);
  out += fmt::format(
      "control interrupt: worst {:.1f} % of the CPU at 20 kHz, {:.1f} % at 40 kHz; asleep {:.1f} %; deepest "
      "stack 0x{:08x}\n",
      100.0 * control.worst_cycles / kControlPeriodCycles,
      200.0 * control.worst_cycles / kControlPeriodCycles,
      100.0 * static_cast<double>(cpu.idle() - idle_before) / span, cpu.lowest_stack());
  out +=
      "Cycles are estimates: instruction timings of the Cortex-M4 manual, a cycle for flash at each taken "
      "branch.\n";
  return out;
}

std::string profile_table(const Board& board, std::size_t functions) {
  std::map<std::uint32_t, std::string> by_address;
  for (const auto& [name, address] : board.image().symbols)
    if (name[0] != '$' && address >= CortexM4::kFlash && address < CortexM4::kFlash + CortexM4::kFlashSize)
      by_address[address & ~1u] = name;
  std::vector<std::pair<std::uint64_t, std::string>> rows;
  std::uint64_t total = 0;
  for (auto at = by_address.begin(); at != by_address.end(); ++at) {
    const auto next = std::next(at);
    const std::uint32_t end =
        next == by_address.end() ? CortexM4::kFlash + CortexM4::kFlashSize : next->first;
    const std::uint64_t cycles = board.cpu().profiled_cycles(at->first, end);
    total += cycles;
    if (cycles > 0) rows.emplace_back(cycles, at->second);
  }
  std::sort(rows.rbegin(), rows.rend());
  std::string out;
  for (std::size_t i = 0; i < std::min(functions, rows.size()); ++i)
    out += fmt::format("{:>6.2f} %  {}\n",
                       100.0 * static_cast<double>(rows[i].first) / static_cast<double>(total),
                       readable(rows[i].second));
  return out;
}

}  // namespace kinebus::emulator
