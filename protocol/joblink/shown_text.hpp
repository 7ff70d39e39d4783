#pragma once
// Text of others (names, M117, words of a job or a file) made fit to be sent and shown: valid UTF-8, of
// bounded length, cut between characters, and without what a terminal or a display would obey.

#include <cstddef>
#include <string>
#include <string_view>

namespace kinebus {

/// Of a sentence's words. A name is shorter (kMaxNameBytes).
inline constexpr std::size_t kMaxWordsBytes = 2000;
inline constexpr std::size_t kMaxNameBytes = 100;

/// The longest front of `text` that has at most `max_bytes` and ends with a whole character.
std::string_view cut_text(std::string_view text, std::size_t max_bytes);

/// At most `max_bytes` of `text`. '?' stands for bytes that are no UTF-8, for control characters (C0, DEL,
/// C1), marks of direction, separators of lines and paragraphs and invisible tags; a tab is a space. So
/// nothing in it moves a cursor, changes a colour or turns the order of what stands beside it.
std::string shown(std::string_view text, std::size_t max_bytes = kMaxWordsBytes);
/// The same, of text in lines: '\n' stays.
std::string shown_lines(std::string_view text, std::size_t max_bytes);

/// shown() would change nothing but the length.
bool is_plain(std::string_view text);
/// Every byte belongs to a character of UTF-8.
bool is_utf8(std::string_view text);

}  // namespace kinebus
