#include "tools/compose/joiner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinebus::compose {
namespace {

/// Writes lines, counts them, and keeps the filament's balance: how far it is drawn back at the moment.
class JobText {
 public:
  explicit JobText(const JoinOptions& options) : options_(options) {}

  template <typename... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    text_ += fmt::format(format, std::forward<Args>(args)...);
    text_ += '\n';
    ++lines_;
  }
  int lines() const { return lines_; }
  std::string take() { return std::move(text_); }

  void retract() {
    if (drawn_back_ >= options_.retract_mm - 1e-6) return;
    feed_filament(drawn_back_ - options_.retract_mm);
  }
  /// A new piece knows nothing of what was drawn back before it.
  void begin_piece() { pulled_ = 0; }

  void item(const SlicedItem& item) {
    if (const auto* words = std::get_if<std::string>(&item)) return line("{}", *words);
    move(std::get<SlicedMove>(item));
  }

 private:
  void feed_filament(double mm) {
    line("G1 E{:.5f} F{:.0f}", mm, options_.retract_mm_per_min);
    drawn_back_ = std::max(0.0, drawn_back_ - mm);
    feed_ = options_.retract_mm_per_min;
  }

  void move(const SlicedMove& move) {
    const bool goes = move.to_mm[0] || move.to_mm[1] || move.to_mm[2] || !move.arc.empty();
    double e_mm = move.e_mm;
    if (move.feed_mm_per_min) feed_ = *move.feed_mm_per_min;
    if (e_mm < 0) {  // drawn back only as far as it is not yet
      pulled_ -= e_mm;
      e_mm = std::min(0.0, drawn_back_ - pulled_);
    } else if (e_mm > 0 && !goes) {  // given back: all that the nozzle lacks, whoever drew it
      pulled_ -= e_mm;
      e_mm = std::max(0.0, drawn_back_ - pulled_);
      pulled_ = std::max(0.0, pulled_);
    } else if (e_mm > 0 && drawn_back_ > pulled_ + 1e-6) {
      const double feed = feed_;
      feed_filament(drawn_back_ - pulled_);
      line("G1 F{:.0f}", feed);
    }
    if (!goes && e_mm == 0 && !move.feed_mm_per_min) return;
    if (move.plane != plane_) {
      plane_ = move.plane;
      line("G{}", plane_);
    }
    std::string words = fmt::format("G{}", move.code);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (move.to_mm[axis]) words += fmt::format(" {}{:.4f}", "XYZ"[axis], *move.to_mm[axis]);
    words += move.arc;
    if (e_mm != 0) {
      // Rounded to five places so that the rounding never adds up.
      const double exact = e_mm + rounding_;
      const double rounded = std::round(exact * 1e5) / 1e5;
      rounding_ = exact - rounded;
      words += fmt::format(" E{:.5f}", rounded);
      drawn_back_ = std::max(0.0, drawn_back_ - e_mm);
      if (goes && e_mm > 0) pulled_ = std::max(0.0, pulled_ - e_mm);
    }
    if (move.feed_mm_per_min) words += fmt::format(" F{:g}", *move.feed_mm_per_min);
    line("{}", words);
  }

  JoinOptions options_;
  std::string text_;
  int lines_ = 0;
  double drawn_back_ = 0;  ///< mm of filament that the next strand needs before it begins
  double pulled_ = 0;      ///< how far the piece's own G-code believes it drawn back
  double rounding_ = 0, feed_ = 0;
  int plane_ = 17;
};

struct Start {
  double x = 0, y = 0, z = 0;
};

/// Where a piece's own moves begin: the place of its first strand.
Start start_of(const SlicedGcode& gcode) {
  std::array<std::optional<double>, 3> first;
  for (const SlicedItem& item : gcode.items) {
    const auto* move = std::get_if<SlicedMove>(&item);
    if (move == nullptr) continue;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!first[axis]) first[axis] = move->to_mm[axis];
    if (first[0] && first[1] && first[2]) break;
  }
  return {first[0].value_or(0), first[1].value_or(0), first[2].value_or(0)};
}

/// How high printed pieces reach along a direction from a place.
double highest(const std::vector<JoinPiece>& pieces, std::size_t count, const PieceFrame& frame) {
  double top = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (int corner = 0; corner < 8; ++corner) {
      const Box& box = pieces[i].box;
      const Vector p((corner & 1) != 0 ? box.high[0] : box.low[0],
                     (corner & 2) != 0 ? box.high[1] : box.low[1],
                     (corner & 4) != 0 ? box.high[2] : box.low[2]);
      top = std::max(top, frame.to_piece(p)[2]);
    }
  return top;
}

template <typename Get>
double first_stated(const std::vector<JoinPiece>& pieces, double otherwise, Get get) {
  for (const JoinPiece& piece : pieces)
    if (const std::optional<double> value = get(piece.gcode)) return *value;
  return otherwise;
}

}  // namespace

JoinedJob join(const std::vector<JoinPiece>& pieces, const JoinOptions& options) {
  JobText out(options);
  JoinedJob job;
  const double hotend =
      first_stated(pieces, options.hotend_celsius, [](const SlicedGcode& g) { return g.hotend_celsius; });
  const double bed =
      first_stated(pieces, options.bed_celsius, [](const SlicedGcode& g) { return g.bed_celsius; });
  const double travel = options.travel_mm_per_min;
  out.line("; {} pieces, each printed along its own direction; joined by kinebus-compose", pieces.size());
  out.line("M140 S{:g}", bed);
  out.line("M104 S{:g}", hotend);
  out.line("M190 S{:g}", bed);
  out.line("M109 S{:g}", hotend);
  out.line("G21 G90 G94 G17");
  out.line("G43.4 H0 ; tool centre point control: the tip stays where it is while the table turns");
  out.line("M83");
  out.retract();
  double top = 0;  // of all that is printed, part coordinates
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const JoinPiece& piece = pieces[i];
    const int first = out.lines() + 1;
    const Start start = start_of(piece.gcode);
    const PieceFrame& frame = piece.frame;
    out.line("; --- piece {} of {}: {}, tilt {:.2f} deg", i + 1, pieces.size(), piece.name, frame.j_deg);
    // Over everything, in the part's own frame; only then the table turns.
    const double safe_z = top + options.clearance_mm;
    out.line("G0 Z{:.3f} F{:.0f}", safe_z, travel);
    out.line("G0 X0 Y0 Z{:.3f}", safe_z);
    out.line("G68.2 X{:.5f} Y{:.5f} Z{:.5f} I{:.6f} J{:.6f} K{:.6f}", frame.origin[0], frame.origin[1],
             frame.origin[2], frame.i_deg, frame.j_deg, frame.k_deg);
    out.line("G53.1 P1 ; the piece's layers are level now");
    const double over =
        std::max(frame.to_piece({0, 0, safe_z})[2], highest(pieces, i, frame) + options.clearance_mm / 2);
    out.line("G0 Z{:.3f} F{:.0f}", over, travel);
    out.line("G0 X{:.4f} Y{:.4f}", start.x, start.y);
    out.line("G0 Z{:.4f}", start.z + 1);
    out.begin_piece();
    for (const SlicedItem& item : piece.gcode.items) out.item(item);
    out.retract();
    // Up along the tool, which stands free over the piece, until above everything else as well.
    top = std::max({top, piece.box.high[2], frame.origin[2]});
    const double up = std::max(frame.axes(2, 2), 0.1);
    double away = 0;
    for (const SlicedItem& item : piece.gcode.items)
      if (const auto* move = std::get_if<SlicedMove>(&item); move != nullptr && move->to_mm[2])
        away = std::max(away, *move->to_mm[2]);
    top = std::max(top, frame.to_part({0, 0, away})[2]);
    const double rise = std::max(0.0, top + options.clearance_mm - frame.to_part({0, 0, away})[2]) / up;
    out.line("G0 Z{:.3f} F{:.0f}", away + rise + options.clearance_mm, travel);
    out.line("G69");
    job.pieces.push_back({first, out.lines()});
  }
  out.line("; --- done");
  out.line("G0 X0 Y0 Z{:.3f} F{:.0f}", top + options.clearance_mm, travel);
  out.line("G0 A0 C0");
  out.line("M107");
  out.line("M104 S0");
  out.line("M140 S0");
  out.line("M2");
  job.text = out.take();
  return job;
}

}  // namespace kinebus::compose
