#include "gui/scene/gcode_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace kinebus::gui {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr int kMaxArcPieces = 720;

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

constexpr unsigned bit(char letter) {
  return 1u << static_cast<unsigned>(letter - 'A');
}

}  // namespace

struct GcodeScanner::Words {
  std::array<double, 26> value{};
  unsigned seen = 0;       ///< a bit a letter
  std::array<int, 8> g{};  ///< tenths: G91.1 is 911
  int g_count = 0;
  int m = -1;
  bool has(char letter) const { return (seen & bit(letter)) != 0; }
  double operator[](char letter) const { return value[static_cast<std::size_t>(letter - 'A')]; }
};

GcodeScanner::GcodeScanner(Options options) : options_(options) {
  for (std::size_t i = 0; i < 3; ++i) at_mm_[i] = options_.start_mm[i];
}

void GcodeScanner::add(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      carry_.append(text);
      return;
    }
    if (carry_.empty()) {
      scan_line(text.substr(0, end));
    } else {
      carry_.append(text.substr(0, end));
      scan_line(carry_);
      carry_.clear();
    }
    text.remove_prefix(end + 1);
  }
}

ToolPath GcodeScanner::finish() {
  if (!carry_.empty()) scan_line(carry_);
  carry_.clear();
  path_.line_count = line_;
  // A job that extrudes nothing is a cut: its feed moves are the work.
  if (!extrudes_)
    for (std::size_t i = 0; i < path_.size(); ++i)
      if (path_.feeds_mm_per_min[i] > 0) path_.kinds[i] = PathKind::kWork;
  for (std::size_t i = 1; i < path_.size(); ++i) {
    if (path_.kinds[i] != PathKind::kWork) continue;
    const auto &a = path_.points_mm[i - 1], &b = path_.points_mm[i];
    path_.bounds_mm.add(a);
    path_.bounds_mm.add(b);
    path_.work_length_mm += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  }
  close_layers();
  ToolPath done = std::move(path_);
  path_ = {};
  return done;
}

bool GcodeScanner::read_words(std::string_view line, Words& words) {
  const char* at = line.data();
  const char* const end = at + line.size();
  bool whole = true;
  while (at < end) {
    char c = *at;
    if (c == ';' || c == '*' || c == '%') break;
    if (c == '(') {
      while (at < end && *at != ')') ++at;
      if (at < end) ++at;
      continue;
    }
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    ++at;
    if (c < 'A' || c > 'Z') {
      if (c == '#' || c == '[') return false;  // a parameter is set: the rest of the line is an expression
      continue;
    }
    if (c == 'O') return false;
    while (at < end && is_space(*at)) ++at;
    if (at < end && *at == '+') ++at;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{}) {
      // A flag such as "G28 X", or an expression.
      if (at < end && (*at == '[' || *at == '#' || *at == '-')) {
        whole = false;
        while (at < end && !is_space(*at)) ++at;
        continue;
      }
    }
    at = next;
    if (c == 'G') {
      if (words.g_count < static_cast<int>(words.g.size()))
        words.g[static_cast<std::size_t>(words.g_count++)] = static_cast<int>(std::lround(value * 10));
    } else if (c == 'M') {
      words.m = static_cast<int>(value);
      if (words.m == 117 || words.m == 118 || words.m == 23 || words.m == 28) break;  // the rest is text
    } else {
      words.value[static_cast<std::size_t>(c - 'A')] = value;
      words.seen |= bit(c);
    }
  }
  return whole;
}

void GcodeScanner::scan_line(std::string_view line) {
  ++line_;
  while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
  if (line.empty() || line.front() == ';' || line.front() == '/') return;
  Words words;
  if (!read_words(line, words)) ++path_.unread_lines;
  codes(words);
}

void GcodeScanner::codes(const Words& words) {
  if (words.m == 82) absolute_e_ = true;
  if (words.m == 83) absolute_e_ = false;
  bool moves = true;
  for (int i = 0; i < words.g_count; ++i) {
    switch (const int g = words.g[static_cast<std::size_t>(i)]; g) {
      case 0:
      case 10:
      case 20:
      case 30:
        motion_ = g / 10;
        break;
      case 170:
      case 180:
      case 190:
        plane_ = g / 10;
        break;
      case 200:
        scale_mm_ = 25.4;
        break;
      case 210:
        scale_mm_ = 1;
        break;
      case 900:
        absolute_ = absolute_e_ = true;
        break;
      case 910:
        absolute_ = absolute_e_ = false;
        break;
      case 901:
        absolute_centre_ = true;
        break;
      case 911:
        absolute_centre_ = false;
        break;
      case 920: {
        moves = false;
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (const char letter = static_cast<char>('X' + axis); words.has(letter))
            offset_mm_[axis] = at_mm_[axis] - words[letter] * scale_mm_;
        if (words.has('E')) e_mm_ = words['E'] * scale_mm_;
        break;
      }
      case 921:
      case 922:
        offset_mm_ = {};
        moves = false;
        break;
      case 40:
      case 100:
      case 110:
      case 280:
      case 290:
      case 300:
      case 430:
        moves = false;
        break;
      default:
        break;
    }
  }
  if (words.has('F') && words['F'] > 0) feed_mm_per_min_ = words['F'] * scale_mm_;
  constexpr unsigned kAxes =
      bit('X') | bit('Y') | bit('Z') | bit('A') | bit('C') | bit('E') | bit('I') | bit('J');
  if (moves && (words.seen & kAxes) != 0) move(words);
}

void GcodeScanner::move(const Words& words) {
  std::array<double, 3> target = at_mm_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char letter = static_cast<char>('X' + axis);
    if (!words.has(letter)) continue;
    const double value = words[letter] * scale_mm_;
    target[axis] = absolute_ ? value + offset_mm_[axis] : at_mm_[axis] + value;
  }
  from_a_rad_ = a_rad_;
  from_c_rad_ = c_rad_;
  if (words.has('A')) a_rad_ = words['A'] * kRadPerDeg + (absolute_ ? 0 : a_rad_);
  if (words.has('C')) c_rad_ = words['C'] * kRadPerDeg + (absolute_ ? 0 : c_rad_);
  const double e_before = e_mm_;
  if (words.has('E')) e_mm_ = words['E'] * scale_mm_ + (absolute_e_ ? 0 : e_mm_);
  const bool turns = a_rad_ != from_a_rad_ || c_rad_ != from_c_rad_;
  const bool is_arc = motion_ == 2 || motion_ == 3;
  if (target == at_mm_ && !turns && !is_arc) return;  // a retraction or a feed alone
  kind_ = e_mm_ > e_before ? PathKind::kWork : PathKind::kTravel;
  extrudes_ = extrudes_ || kind_ == PathKind::kWork;
  if (turns && path_.tilts_rad.empty())
    path_.tilts_rad.assign(path_.size(), {static_cast<float>(from_a_rad_), static_cast<float>(from_c_rad_)});
  // The first vertex is where the job begins.
  if (path_.size() == 0) {
    const PathKind kind = kind_;
    kind_ = PathKind::kTravel;
    put(at_mm_, 0);
    kind_ = kind;
  }
  if (is_arc)
    arc(words, target);
  else
    put(target, 1);
  at_mm_ = target;
}

void GcodeScanner::arc(const Words& words, const std::array<double, 3>& target_mm) {
  // The plane's two axes and the one along the helix; counter-clockwise as seen from that axis' positive end.
  const std::size_t u = plane_ == 18 ? 2 : plane_ == 19 ? 1 : 0;
  const std::size_t v = plane_ == 18 ? 0 : plane_ == 19 ? 2 : 1;
  const bool clockwise = motion_ == 2;
  const double du = target_mm[u] - at_mm_[u], dv = target_mm[v] - at_mm_[v];
  double cu = 0, cv = 0;  // centre
  if (words.has('R')) {
    const double r = words['R'] * scale_mm_, chord = std::hypot(du, dv);
    if (!(chord > 0)) return put(target_mm, 1);
    const double height = std::sqrt(std::max(0.0, r * r - chord * chord / 4));
    const double side = (clockwise ? -1.0 : 1.0) * (r < 0 ? -1.0 : 1.0);
    cu = at_mm_[u] + du / 2 - side * height * dv / chord;
    cv = at_mm_[v] + dv / 2 + side * height * du / chord;
  } else {
    const auto offset = [&](std::size_t axis) {
      const double value = words[static_cast<char>('I' + axis)] * scale_mm_;
      return absolute_centre_ ? value + offset_mm_[axis] : at_mm_[axis] + value;
    };
    cu = offset(u);
    cv = offset(v);
  }
  const double radius = std::hypot(at_mm_[u] - cu, at_mm_[v] - cv);
  const double start = std::atan2(at_mm_[v] - cv, at_mm_[u] - cu);
  double sweep = std::atan2(target_mm[v] - cv, target_mm[u] - cu) - start;
  constexpr double kTurn = 2 * std::numbers::pi;
  if (clockwise && sweep > -1e-9) sweep -= kTurn;
  if (!clockwise && sweep < 1e-9) sweep += kTurn;
  if (words.has('P') && words['P'] > 1) sweep += (clockwise ? -kTurn : kTurn) * (words['P'] - 1);
  const double tolerance = options_.arc_tolerance_mm;
  const double step = radius > tolerance ? 2 * std::acos(1 - tolerance / radius) : kTurn / 8;
  const int pieces = std::clamp(static_cast<int>(std::ceil(std::abs(sweep) / step)), 1, kMaxArcPieces);
  for (int i = 1; i < pieces; ++i) {
    const double share = static_cast<double>(i) / pieces, angle = start + sweep * share;
    std::array<double, 3> point{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      point[axis] = at_mm_[axis] + (target_mm[axis] - at_mm_[axis]) * share;
    point[u] = cu + radius * std::cos(angle);
    point[v] = cv + radius * std::sin(angle);
    put(point, share);
  }
  put(target_mm, 1);
}

/// share: of the move, 0 .. 1, for what turns along with it.
void GcodeScanner::put(const std::array<double, 3>& point_mm, double share) {
  path_.points_mm.push_back(
      {static_cast<float>(point_mm[0]), static_cast<float>(point_mm[1]), static_cast<float>(point_mm[2])});
  path_.lines.push_back(line_);
  path_.kinds.push_back(kind_);
  const double feed = motion_ == 0 ? 0 : std::clamp(feed_mm_per_min_, 1.0, 65535.0);
  path_.feeds_mm_per_min.push_back(static_cast<std::uint16_t>(feed));
  if (!path_.tilts_rad.empty() || a_rad_ != 0 || c_rad_ != 0)
    path_.tilts_rad.push_back({static_cast<float>(from_a_rad_ + (a_rad_ - from_a_rad_) * share),
                               static_cast<float>(from_c_rad_ + (c_rad_ - from_c_rad_) * share)});
}

void GcodeScanner::close_layers() {
  const auto count = static_cast<std::uint32_t>(path_.size());
  for (std::uint32_t i = 1; i < count; ++i) {
    if (path_.kinds[i] != PathKind::kWork) continue;
    const float z = path_.points_mm[i][2];
    const bool first = path_.layers.empty();
    if (!first && std::abs(z - path_.layers.back().z_mm) < options_.layer_height_min_mm) continue;
    // A layer begins where the travel to it begins, so that every vertex is in one.
    std::uint32_t begin = i;
    while (begin > 0 && path_.kinds[begin - 1] == PathKind::kTravel) --begin;
    if (!first) begin = std::max(begin, path_.layers.back().first + 1);
    if (first) begin = 0;
    if (!first) path_.layers.back().last = begin;
    path_.layers.push_back({begin, count, z});
  }
  if (path_.layers.empty() && count > 0) path_.layers.push_back({0, count, path_.points_mm.front()[2]});
}

}  // namespace kinebus::gui
