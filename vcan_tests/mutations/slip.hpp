// What tools/mutations writes into mutated copies of the sources: see slips.py. Included by no source of the
// repository.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <type_traits>

namespace slip {

inline constexpr int kMost = 1 << 16;
inline const int chosen = [] {
  const char* number = std::getenv("KINEBUS_SLIP");
  return number == nullptr ? 0 : std::atoi(number);
}();
inline unsigned char reached[kMost];

/// At the end of the program: the numbers of all places that were passed.
struct Report {
  ~Report() {
    const char* path = std::getenv("KINEBUS_SLIPS_REACHED");
    std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "a");
    if (file == nullptr) return;
    for (int i = 0; i < kMost; ++i)
      if (reached[i] != 0) std::fprintf(file, "%d\n", i);
    std::fclose(file);
  }
};
inline const Report report;

/// Whether the slip of this number is the one to be made.
constexpr bool made(int number) {
  if (std::is_constant_evaluated()) return false;
  reached[number] = 1;
  return number == chosen;
}

#define KINEBUS_SLIP_OF(name, right, wrong)                 \
  template <class A, class B>                               \
  constexpr auto name(int number, const A& a, const B& b) { \
    return made(number) ? (a wrong b) : (a right b);        \
  }
KINEBUS_SLIP_OF(lt, <, <=)
KINEBUS_SLIP_OF(le, <=, <)
KINEBUS_SLIP_OF(gt, >, >=)
KINEBUS_SLIP_OF(ge, >=, >)
KINEBUS_SLIP_OF(eq, ==, !=)
KINEBUS_SLIP_OF(ne, !=, ==)
KINEBUS_SLIP_OF(add, +, -)
KINEBUS_SLIP_OF(sub, -, +)
#undef KINEBUS_SLIP_OF

}  // namespace slip
