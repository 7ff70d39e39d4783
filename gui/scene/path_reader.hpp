#pragma once
// Reads G-code for the eye: moves and arcs of both dialects into a ToolPath, at some tens of megabytes a
// second. It judges nothing (the gateway's pre-flight does that) and computes no expressions: a line with one
// is counted as unread and its other words are used.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "gui/scene/tool_path.hpp"

namespace kinebus::gui {

class GcodeScanner {
 public:
  struct Options {
    float arc_tolerance_mm = 0.02F;     ///< a chord may leave its arc by this
    float layer_height_min_mm = 0.03F;  ///< a smaller rise does not begin a layer: spirals have layers too
    std::array<float, 3> start_mm{0, 0, 20};
  };

  GcodeScanner() : GcodeScanner(Options{}) {}
  explicit GcodeScanner(Options options);
  /// The next part of the text, cut anywhere.
  void add(std::string_view text);
  /// Ends the last line and closes the layers. The scanner is empty then.
  ToolPath finish();
  std::uint32_t lines_read() const { return line_; }

 private:
  struct Words;
  void scan_line(std::string_view line);
  bool read_words(std::string_view line, Words& words);
  void codes(const Words& words);
  void move(const Words& words);
  void arc(const Words& words, const std::array<double, 3>& target_mm);
  void put(const std::array<double, 3>& point_mm, double share);
  void close_layers();

  Options options_;
  ToolPath path_;
  std::string carry_;  ///< the beginning of a line whose end has not come yet
  std::uint32_t line_ = 0;

  // Modal state.
  int motion_ = 0;
  int plane_ = 17;
  double scale_mm_ = 1;
  bool absolute_ = true, absolute_e_ = true, absolute_centre_ = false;
  std::array<double, 3> at_mm_{}, offset_mm_{};
  double e_mm_ = 0, a_rad_ = 0, c_rad_ = 0;
  double feed_mm_per_min_ = 1500;
  // The move at work.
  double from_a_rad_ = 0, from_c_rad_ = 0;
  PathKind kind_ = PathKind::kTravel;
  bool extrudes_ = false;  ///< any extrusion so far
};

}  // namespace kinebus::gui
