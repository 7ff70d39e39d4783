#pragma once
// What a job has printed so far as a body of the scene: it stands on the table, grows with the job, and
// bodies of the machine come close to it.

#include <QMatrix4x4>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>

#include "gateway/bodies/collision_model.hpp"
#include "gui/scene/tool_path.hpp"

namespace kinebus::gui {

class PrintedBody {
 public:
  /// The table is empty.
  void clear();
  bool empty() const { return blocks_.empty(); }
  /// All that is extruded before vertex `done` of `path`; another path, or an earlier vertex, begins anew. At
  /// most `most_vertices` are taken at once: false as long as there are more.
  bool follow(const std::shared_ptr<const ToolPath>& path, std::uint32_t done,
              std::uint32_t most_vertices = kMostVertices);
  const Box& bounds_mm() const { return bounds_mm_; }  ///< table coordinates

  struct Near {
    bodies::BodyId body{};
    double mm = 0;
  };
  /// The body of the machine with the least left to the distance that it must keep, when that is less than
  /// `close_mm`. `placed`: where the bodies are; `part_frame`: table coordinates to machine frame. The tool
  /// is left out, whose tip lays the part down, and what carries the table.
  std::optional<Near> comes_close(const bodies::CollisionModel& solid, const bodies::Scene& placed,
                                  const QMatrix4x4& part_frame, double close_mm) const;

 private:
  static constexpr std::uint32_t kMostVertices = 20'000;
  void add_line(const std::array<float, 3>& from, const std::array<float, 3>& to);
  void add(const std::array<float, 3>& point);

  std::shared_ptr<const ToolPath> path_;
  std::uint32_t taken_ = 0;                        ///< vertices
  std::unordered_map<std::uint64_t, Box> blocks_;  ///< what lies in each cube of kBlock_mm
  Box bounds_mm_;
};

}  // namespace kinebus::gui
