#include "gateway/description/commented_file.hpp"

#include <cctype>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace kinebus {
namespace {

constexpr std::size_t kCommentColumn = 32;

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// "joint.tower1.homing" of "[joint.tower1.homing]  # ..."; empty: no table's line.
std::string table_of(const std::string& line) {
  if (line.empty() || line[0] != '[') return {};
  return line.substr(1, line.find(']') - 1);
}

/// The same for all tables of a kind: "joint.*.homing", "node.*.input*".
std::string kind_of(const std::string& table) {
  std::string kind;
  std::istringstream in(table);
  int depth = 0;
  bool names = false;
  for (std::string part; std::getline(in, part, '.'); ++depth) {
    if (depth == 0)
      names = part != "kinematics" && part != "calibration" && part != "vibration";
    else if (depth == 1 && names)
      part = "*";
    else if (!part.empty() && std::isdigit(static_cast<unsigned char>(part.back())) != 0)
      part.back() = '*';
    kind += (depth == 0 ? "" : ".") + part;
  }
  return kind;
}

/// Of tables whose keys mean the same though more is said of each: parts of the frame.
std::string kind_of_keys(const std::string& kind) {
  return kind.starts_with("bodies.*.") ? "bodies.*.*" : kind;
}

/// "speed_mm_per_s" of "speed_mm_per_s = 3  # ..."; empty: no key's line.
std::string key_of(const std::string& line) {
  const std::size_t equals = line.find(" = ");
  if (equals == std::string::npos || line[0] == '#' || line.find('#') < equals) return {};
  return line.substr(0, equals);
}

/// From # on, outside of strings; empty: none.
std::string comment_of(const std::string& line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '#' && !quoted) return line.substr(i);
  }
  return {};
}

/// By kind of table and key; the key of what stands above a table, or behind its name, is "[" or "]".
using Comments = std::map<std::pair<std::string, std::string>, std::string>;

void collect(std::string_view example, Comments& comments) {
  std::string kind, above;
  for (const std::string& line : lines_of(example)) {
    if (!line.empty() && line[0] == '#') {
      above += line + "\n";
      continue;
    }
    if (const std::string table = table_of(line); !table.empty()) {
      kind = kind_of(table);
      comments.emplace(std::pair(kind, "["), above);
      comments.emplace(std::pair(kind, "]"), comment_of(line));
    } else if (const std::string key = key_of(line); !key.empty()) {
      if (const std::string comment = comment_of(line); !comment.empty())
        comments.emplace(std::pair(kind_of_keys(kind), key), comment);
    }
    above.clear();
  }
}

}  // namespace

std::string with_comments(std::string_view written, std::span<const std::string_view> examples,
                          const FileRemarks& remarks) {
  Comments comments;
  for (const std::string_view example : examples) {
    Comments of_one;
    collect(example, of_one);
    comments.merge(of_one);
  }
  const auto take = [&](const std::string& kind, const std::string& key) {
    const auto found = comments.find({kind, key});
    return found == comments.end() ? std::string() : std::exchange(found->second, {});
  };
  std::string text = remarks.header, kind;
  for (const std::string& line : lines_of(written)) {
    std::string comment;
    if (const std::string table = table_of(line); !table.empty()) {
      kind = kind_of(table);
      const auto own = remarks.tables.find(table);
      const std::string above = take(kind, "[");
      // What is said of this very table takes the place of what holds for its kind.
      text += own == remarks.tables.end() ? above : "# " + own->second + "\n";
      comment = take(kind, "]");
    } else if (const std::string key = key_of(line); !key.empty()) {
      comment = take(kind_of_keys(kind), key);
    }
    text += line;
    if (!comment.empty()) {
      text.append(line.size() < kCommentColumn ? kCommentColumn - line.size() : 1, ' ');
      text += comment;
    }
    text += '\n';
  }
  return text;
}

}  // namespace kinebus
