#include "vcan_tests/emulator/board_words.hpp"

#include <array>
#include <cstdio>
#include <stdexcept>

#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"

namespace kinebus::emulator {
namespace {

struct Kind {
  std::string_view word;
  BoardMaker make;
};
constexpr std::array<Kind, 4> kKinds{{{"stm32f405", &make_board<Board>},
                                      {"stm32f446_octopus", &make_board<OctopusBoard>},
                                      {"stm32g0b1_ebb", &make_board<EbbBoard>},
                                      {"stm32g0b1_ebb_heat", &make_board<EbbHeatBoard>}}};
constexpr int kInputs = 7;

}  // namespace

std::vector<std::string> board_words() {
  std::vector<std::string> words;
  words.reserve(kKinds.size());
  for (const Kind& kind : kKinds) words.emplace_back(kind.word);
  return words;
}

BoardMaker maker_of(std::string_view word) {
  for (const Kind& kind : kKinds)
    if (kind.word == word) return kind.make;
  return nullptr;
}

EmulatedNodeOptions further_board(const std::string& text, std::deque<ElfImage>& images) {
  const std::size_t equals = text.find('=');
  EmulatedNodeOptions options;
  options.make = maker_of(text.substr(0, equals));
  if (equals == std::string::npos || options.make == nullptr)
    throw std::runtime_error("--also: found " + text + "; expected KIND=IMAGE, with a kind as --board has");
  options.node_id = 0;
  options.image = &images.emplace_back(load_elf(text.substr(equals + 1)));
  options.board.unique_id = {0x00330045, 0x31365108, 0x36373900u + static_cast<std::uint32_t>(images.size())};
  return options;
}

void wire_switch(const std::string& text, std::vector<EmulatedNodeOptions>& boards) {
  int board = -1, motor = -1, input = -1, end = 0;
  double counts = 0;
  if (std::sscanf(text.c_str(), "%d:%d:%d:%lf%n", &board, &motor, &input, &counts, &end) != 4 ||
      static_cast<std::size_t>(end) != text.size() || board < 0 || board >= static_cast<int>(boards.size()) ||
      motor < 0 || motor >= 8 || input < 0 || input >= kInputs)
    throw std::runtime_error("--switch: found " + text + "; expected BOARD:MOTOR:INPUT:COUNTS, from 0 on");
  VirtualAxis& axis = boards[static_cast<std::size_t>(board)].board.axes[static_cast<std::size_t>(motor)];
  axis.switch_input = input + 1;
  axis.switch_counts = axis.start_counts + counts;
  axis.active_above = counts > 0;
}

}  // namespace kinebus::emulator
