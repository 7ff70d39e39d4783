#pragma once
// Boards and what is around them, as they are named on the command line.

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

/// Kinds of boards that are emulated.
std::vector<std::string> board_words();
/// Of one of those words.
BoardMaker maker_of(std::string_view word);
/// "stm32g0b1_ebb=kinebus-ebb-g0b1.elf": a further board, without a node id; its image is kept in `images`.
/// Throws std::runtime_error, in words.
EmulatedNodeOptions further_board(const std::string& text, std::deque<ElfImage>& images);
/// "0:2:3:-4000": board 0's motor 2 holds its input 3 high at and below -4000 counts from where it stands;
/// with a positive number, at and above. All count from 0. Throws std::runtime_error, in words.
void wire_switch(const std::string& text, std::vector<EmulatedNodeOptions>& boards);

}  // namespace kinebus::emulator
