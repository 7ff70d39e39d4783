#pragma once
// TOML 1.0 allows characters beyond ASCII in comments and strings only. toml++ 3.3 has undefined behaviour
// for some of them elsewhere (is_non_ascii_horizontal_whitespace), so they are looked for before it reads the
// text.

#include <cstdint>
#include <optional>
#include <string_view>

namespace kinebus {

/// Line (1-based) of the first such character outside comments and strings.
std::optional<std::uint32_t> misplaced_character(std::string_view toml);

}  // namespace kinebus
