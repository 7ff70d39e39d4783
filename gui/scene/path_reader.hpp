#pragma once
// Reads a job for the eye with the gateway's own interpreter: what is drawn is what will move. Offsets,
// tilted planes, expressions and arcs are worked out there; here canonical commands become a ToolPath in part
// coordinates. A line that is refused is counted and left out, and the reading goes on behind it.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "gateway/gcode/interpreter.hpp"
#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/pose.hpp"
#include "gui/scene/path_features.hpp"
#include "gui/scene/tool_path.hpp"

namespace kinebus::gui {

class PathReader {
 public:
  struct Options {
    gcode::Options machine = any_machine();  ///< as far as it is known
    float arc_tolerance_mm = 0.02F;          ///< a chord may leave its arc by this
    float layer_height_min_mm = 0.03F;  ///< a smaller rise does not begin a layer: spirals have layers too
  };
  /// A machine of which nothing is known: the machine file's defaults, a spindle (S and M3 are no errors
  /// here), the tool 20 mm above the table.
  static gcode::Options any_machine();

  PathReader() : PathReader(Options{}) {}
  explicit PathReader(Options options);
  PathReader(const PathReader&) = delete;
  PathReader& operator=(const PathReader&) = delete;

  /// The next part of the text, cut anywhere.
  void add(std::string_view text);
  /// Ends the last line and closes the layers. The reader is of no use then.
  ToolPath finish();

 private:
  void drain();
  void take(const canonical::Line& line);
  void follow_plane();
  void straight(const Pose& target, double feed_mm_per_min);
  void turn(const canonical::Arc& arc);
  bool begin_move(const Pose& target, bool is_arc);
  void put(const Pose& pose, double feed_mm_per_min);
  double feed_of(const canonical::Feed& feed) const;
  std::vector<PathLayer> layers() const;

  Options options_;
  gcode::Interpreter interpreter_;
  gcode::JobReader reader_;
  FeatureScanner features_;
  gcode::CommandBuffer commands_;
  ToolPath path_;

  Pose at_{};  ///< as the last command left it, in frame_
  Frame frame_ = Frame::kMachine;
  std::uint32_t line_ = 0;
  PathKind kind_ = PathKind::kTravel;  ///< of the move at work
  bool extrudes_ = false;              ///< any extrusion so far

  // Layers of what is made in a tilted plane lie in that plane.
  bool tilted_ = false;
  std::array<double, 3> up_{0, 0, 1};  ///< the plane's normal, part coordinates
  double zero_mm_ = 0;                 ///< height above the plane's zero is up_ * point - zero_mm_
  std::vector<float> heights_mm_;      ///< of the vertices; empty as long as no plane was tilted: their Z
  std::vector<std::uint32_t> planes_;  ///< first vertex of each plane but the first
};

}  // namespace kinebus::gui
