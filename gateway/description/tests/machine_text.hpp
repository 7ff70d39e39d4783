#pragma once
// The repository's machine files as text, whole or with something changed.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "gateway/description/machines_folder.hpp"

namespace kinebus {

inline const std::filesystem::path kMachines = machines_folder();

inline std::string file_text(const std::string& name) {
  std::ifstream in(kMachines / name);
  EXPECT_TRUE(in) << name;
  std::ostringstream out;
  out << in.rdbuf();
  return std::move(out).str();
}

/// The default machine file with one piece of text replaced, and the line where that piece begins.
struct Edited {
  std::string text;
  std::uint32_t line = 0;
};
inline Edited edited(std::string_view from, std::string_view to, const std::string& file = "m1.toml") {
  std::string text = file_text(file);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  const auto line =
      static_cast<std::uint32_t>(1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
  text.replace(at, from.size(), to);
  return {text, line};
}

}  // namespace kinebus
