#include "gateway/sessions/console.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace kinebus {
namespace {

struct Code {
  char letter = 0;
  int number = -1;
};

/// The first word of the line.
Code code_of(std::string_view line) {
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  if (line.empty() || line.front() == ';') return {};
  Code code{static_cast<char>(std::toupper(static_cast<unsigned char>(line.front()))), -1};
  line.remove_prefix(1);
  for (int digits = 0; !line.empty() && digits < 5 && line.front() >= '0' && line.front() <= '9'; ++digits) {
    code.number = std::max(code.number, 0) * 10 + (line.front() - '0');
    line.remove_prefix(1);
  }
  // G28.1 is another code than G28.
  if (!line.empty() && line.front() == '.') code.number = -1;
  return code;
}

constexpr std::array<int, 8> kQueries{27, 105, 112, 114, 115, 119, 410, 503};
constexpr std::array<int, 15> kSessionCommands{17,  18,  24,  25,  84,  104, 106, 107,
                                               140, 220, 303, 524, 906, 956, 999};

template <std::size_t n>
bool contains(const std::array<int, n>& codes, int code) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

/// Changes nothing. M420 without S and Z tells the bed's mesh, M956 without S what was felt.
bool asks(const Code& code, std::string_view line) {
  if (code.letter != 'M') return false;
  return contains(kQueries, code.number) ||
         ((code.number == 420 || code.number == 956) &&
          line.substr(0, line.find(';')).find_first_of("SsZz") == std::string_view::npos);
}

}  // namespace

bool needs_control(std::string_view line) {
  const Code code = code_of(line);
  return code.letter != 0 && !asks(code, line);
}

Result<std::string, Refusal> console_line(Gateway& gateway, std::string_view line) {
  const Code code = code_of(line);
  if (code.letter == 0) return std::string();
  const bool home = code.letter == 'G' && code.number == 28;
  const bool session = asks(code, line) || (code.letter == 'M' && contains(kSessionCommands, code.number));
  if (home || session) return gateway.text_line(line);
  if (const auto done = run_line(gateway, line); !done) return Error<Refusal>(done.error());
  return std::string("ok");
}

Result<void, Refusal> run_line(Gateway& gateway, std::string_view line) {
  // What does not move is taken in any state, and leaves the machine's state as it is.
  auto at_rest = gateway.take_line(line, 1);
  if (at_rest || gateway.state() != MachineState::kReady) return at_rest;
  if (auto opened = gateway.carry_out(command::OpenLines{"console"}); !opened) return opened;
  auto moved = gateway.take_line(line, 1);
  gateway.close_lines();
  return moved;
}

}  // namespace kinebus
