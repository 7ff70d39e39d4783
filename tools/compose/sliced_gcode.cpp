#include "tools/compose/sliced_gcode.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/gcode/words/codes.hpp"
#include "gateway/pose.hpp"

namespace kinebus::compose {
namespace {

// Where the tool stands as long as the piece has not said where: the composer brings it to the first place
// that it states. Farther away than any piece.
constexpr double kUnplaced_mm = 1e6;
constexpr double kNoMotion_mm = 1e-9;
constexpr std::size_t kFilament = 5;

bool placed(double coordinate_mm) {
  return std::abs(coordinate_mm) < kUnplaced_mm / 2;
}

gcode::Options piece_options() {
  gcode::Options options;
  options.start = options.home = {kUnplaced_mm, kUnplaced_mm, kUnplaced_mm, 0, 0, 0};
  options.default_feed_mm_per_s = 25;
  options.traverse_uses_feed = true;
  options.arc_radius_tolerance_mm = 0.01;
  options.spindle = true;  // S in a move: laser power in some dialects
  options.retract_length_mm = 0.8;
  options.retract_mm_per_s = options.recover_mm_per_s = 35;
  return options;
}

/// "M104" of "N5 M104 S200"; empty: no G or M code begins the line.
std::string head_of(std::string_view line) {
  std::size_t at = line.find_first_not_of(" \t");
  if (at != std::string_view::npos && (line[at] | 0x20) == 'n')
    at = line.find_first_not_of(" \t", line.find_first_not_of("0123456789", at + 1));
  if (at == std::string_view::npos || ((line[at] | 0x20) != 'g' && (line[at] | 0x20) != 'm')) return {};
  const std::size_t end = line.find_first_not_of("0123456789.", at + 1);
  std::string head(line.substr(at, end == std::string_view::npos ? end : end - at));
  head[0] = static_cast<char>(head[0] & ~0x20);
  return head;
}

/// Codes whose effect is contained in the moves.
bool is_in_the_moves(const std::string& head) {
  using gcode::GGroup;
  if (head.empty() || head[0] == 'M') return head.empty() || head == "M82" || head == "M83" || head == "M221";
  const auto tenths = static_cast<int>(std::lround(std::strtod(head.c_str() + 1, nullptr) * 10));
  switch (gcode::g_group(tenths)) {
    case GGroup::kMotion:
    case GGroup::kUnits:
    case GGroup::kFeedMode:
    case GGroup::kPlane:
    case GGroup::kCoordinates:
    case GGroup::kDistance:
    case GGroup::kCentre:
      return true;
    case GGroup::kNonmodal:
      return tenths != 280;
    default:
      return false;
  }
}

class Reader {
 public:
  explicit Reader(const std::string& name)
      : name_(name), interpreter_(piece_options()), lines_(interpreter_), at_(piece_options().start) {}

  void read(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.find_first_of("\r\n");
      const std::string_view line = text.substr(0, end);
      // A line end of two bytes is one.
      const std::size_t size = end == std::string_view::npos          ? text.size()
                               : text.substr(end).starts_with("\r\n") ? end + 2
                                                                      : end + 1;
      this->line(line, text.substr(0, size));
      text.remove_prefix(size);
    }
    if (const auto done = lines_.finish(commands_); !done) refuse(done.error().line, done.error().message);
    drain();
  }

  SlicedGcode finish() {
    out_.layers = static_cast<int>(heights_.size());
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(std::uint32_t line, const std::string& why) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", name_, line, why));
  }

  /// Comments that tell what is printed are kept; the slicer's settings are not.
  static bool is_mark(std::string_view comment) {
    return comment.starts_with(";TYPE:") || comment.starts_with(";LAYER_CHANGE") ||
           comment.starts_with(";Z:");
  }

  void line(std::string_view text, std::string_view with_end) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first != std::string_view::npos && is_mark(text.substr(first)))
      out_.items.emplace_back(std::string(text.substr(first)));
    const std::string head = head_of(text);
    // What machines have of their own is left out, whether it is known here or not.
    const bool unknown = head.size() > 1 && head[0] == 'M' &&
                         gcode::m_group(std::atoi(head.c_str() + 1)) == gcode::MGroup::kUnknown;
    const std::size_t before = out_.items.size();
    if (const auto taken = lines_.read(unknown ? with_end.substr(text.size()) : with_end, commands_); !taken)
      refuse(taken.error().line, taken.error().message);
    drain();
    if (out_.items.size() == before && !is_in_the_moves(head)) ++out_.left_out[head];
  }

  void drain() {
    for (const canonical::Line& line : commands_) take(line);
    commands_.clear();
  }

  void take(const canonical::Line& line) {
    const auto& command = line.command;
    if (const auto* feed = std::get_if<canonical::Feed>(&command)) {
      const double tool =
          std::hypot(feed->target[0] - at_[0], feed->target[1] - at_[1], feed->target[2] - at_[2]);
      const double length = tool > 0 ? tool : std::abs(feed->target[kFilament] - at_[kFilament]);
      const double per_s = feed->inverse_time_s > 0 ? length / feed->inverse_time_s : feed->feed_per_s;
      move(line.line, 1, feed->target, per_s);
    } else if (const auto* traverse = std::get_if<canonical::Traverse>(&command)) {
      move(line.line, 0, traverse->target, traverse->speed_per_s);
    } else if (const auto* arc = std::get_if<canonical::Arc>(&command)) {
      turn(line.line, *arc);
    } else if (const auto* set = std::get_if<canonical::SetPosition>(&command)) {
      if (set->frame != Frame::kMachine)
        refuse(line.line, "frames are set by the composer; export the piece in its own coordinates");
      at_ = set->pose;
    } else if (const auto* home = std::get_if<canonical::Home>(&command)) {
      at_ = home->afterwards;
    } else if (const auto* dwell = std::get_if<canonical::Dwell>(&command)) {
      out_.items.emplace_back(fmt::format("G4 S{:g}", dwell->seconds));
    } else if (const auto* thermal = std::get_if<canonical::Thermal>(&command)) {
      heat(*thermal);
    }
  }

  void heat(const canonical::Thermal& thermal) {
    using What = canonical::Thermal::What;
    if (thermal.what == What::kFan) {
      const std::string which = thermal.index == 0 ? "" : fmt::format(" P{}", thermal.index);
      out_.items.emplace_back(thermal.value > 0 ? fmt::format("M106{} S{:g}", which, thermal.value * 255)
                                                : fmt::format("M107{}", which));
      return;
    }
    if (thermal.what == What::kOutput) {
      out_.items.emplace_back(fmt::format("M42 P{} S{:g}", thermal.index, thermal.value * 255));
      return;
    }
    if (thermal.what == What::kChamber) {
      out_.items.emplace_back(fmt::format("{} P{} {}{:g}", thermal.wait ? "M191" : "M141", thermal.index,
                                          thermal.wait_cooling ? 'R' : 'S', thermal.value));
      return;
    }
    std::optional<double>& celsius = thermal.what == What::kBed ? out_.bed_celsius : out_.hotend_celsius;
    if (thermal.value > 0 && !celsius) celsius = thermal.value;
  }

  SlicedMove& move(std::uint32_t line, int code, const Pose& target, double feed_per_s) {
    if (target[3] != 0 || target[4] != 0) refuse(line, "A and C are turned by the composer");
    SlicedMove move;
    move.code = code;
    const bool across = target[0] != at_[0] || target[1] != at_[1];
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (placed(target[axis]) && (axis == 2 ? target[2] != at_[2] : across)) move.to_mm[axis] = target[axis];
    move.e_mm = target[kFilament] - at_[kFilament];
    if (std::abs(move.e_mm) < kNoMotion_mm) move.e_mm = 0;
    if (const double feed = feed_per_s * 60; feed > 0 && std::abs(feed - feed_) > 1e-9 * feed)
      move.feed_mm_per_min = feed_ = feed;
    if (move.e_mm > 0 && (move.to_mm[0] || move.to_mm[1] || move.to_mm[2])) {
      if (!placed(at_[0]) || !placed(at_[1]) || !placed(target[2]))
        refuse(line, "filament is fed before X, Y and Z are stated");
      if (across) heights_.insert(std::lround(target[2] * 1000));
    }
    out_.filament_mm += move.e_mm;
    at_ = target;
    out_.items.emplace_back(std::move(move));
    return std::get<SlicedMove>(out_.items.back());
  }

  void turn(std::uint32_t line, const canonical::Arc& arc) {
    std::size_t w = 2;
    for (const std::size_t axis : {0U, 1U})
      if (std::abs(arc.normal[axis]) > 0.5) w = axis;
    const std::size_t u = (w + 1) % 3, v = (w + 2) % 3;
    if (!placed(at_[0]) || !placed(at_[1]) || !placed(at_[2]))
      refuse(line, "an arc begins before X, Y and Z are stated");
    std::array<double, 3> centre{};
    for (const std::size_t axis : {u, v}) centre[axis] = arc.centre_mm[axis] - at_[axis];
    const Pose start = at_;
    const double length = std::hypot(centre[u], centre[v]) * arc.sweep_rad;
    SlicedMove& move = this->move(line, arc.normal[w] > 0 ? 3 : 2, arc.target,
                                  arc.inverse_time_s > 0 ? length / arc.inverse_time_s : arc.feed_per_s);
    move.plane = w == 2 ? 17 : w == 1 ? 18 : 19;
    for (const std::size_t axis : {u, v}) move.arc += fmt::format(" {}{:.5f}", "IJK"[axis], centre[axis]);
    // An end that is stated tells an arc from a full circle: both coordinates of the plane, or none.
    const bool circle = arc.target[u] == start[u] && arc.target[v] == start[v];
    for (const std::size_t axis : {u, v})
      move.to_mm[axis] = circle ? std::nullopt : std::optional(arc.target[axis]);
    if (const double turns = std::ceil(arc.sweep_rad / (2 * std::numbers::pi) - 1e-9); turns > 1)
      move.arc += fmt::format(" P{:.0f}", turns);
  }

  std::string name_;
  gcode::Interpreter interpreter_;
  gcode::JobReader lines_;
  gcode::CommandBuffer commands_;
  Pose at_{};
  double feed_ = 0;
  std::set<long> heights_;
  SlicedGcode out_;
};

}  // namespace

SlicedGcode read_sliced(std::string_view text, const std::string& name) {
  Reader reader(name);
  reader.read(text);
  return reader.finish();
}

}  // namespace kinebus::compose
