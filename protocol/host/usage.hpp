#pragma once
// The arguments of every program: what is wrong with them is said on stderr, and the exit status is 2.

#include <CLI/CLI.hpp>
#include <optional>

namespace kinebus {

constexpr int kUsageError = 2;

/// nullopt: go on. Else the program's exit status: 0 after help or version, kUsageError after words on what
/// is wrong.
inline std::optional<int> parse_arguments(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageError;
  }
  return std::nullopt;
}

}  // namespace kinebus
