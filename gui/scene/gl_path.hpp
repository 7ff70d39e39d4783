#pragma once
// A path on the graphics card: one vertex buffer, an index buffer a level. Filled in slices, so that no
// picture waits for a long copy.

#include <QOpenGLBuffer>
#include <QOpenGLExtraFunctions>
#include <QOpenGLVertexArrayObject>
#include <memory>
#include <vector>

#include "gui/scene/path_colours.hpp"
#include "gui/scene/path_plan.hpp"

namespace kinebus::gui {

/// All of a job that the scene needs; made by the loader's thread, then never changed.
struct ScenePath {
  ToolPath path;
  PathLevels levels;
  PathShades shades;
};

class GlPath {
 public:
  /// Begins with another path; null: none.
  void set(QOpenGLExtraFunctions& gl, std::shared_ptr<const ScenePath> scene);
  /// Copies at most `bytes` more. True when all is there.
  bool copy_some(QOpenGLExtraFunctions& gl, std::size_t bytes);
  bool ready() const { return scene_ != nullptr && next_ >= tasks_.size(); }
  const ScenePath* scene() const { return scene_.get(); }
  void release();
  /// With the caller's program bound. Lines `skip` .. skip + count - 1 of the range.
  void draw(QOpenGLExtraFunctions& gl, const DrawRange& range, std::uint32_t skip, std::uint32_t count);

 private:
  struct Task {
    QOpenGLBuffer* buffer;
    const char* data;
    std::size_t bytes;
    std::size_t done;
  };
  QOpenGLBuffer& indices(const DrawRange& range);

  std::shared_ptr<const ScenePath> scene_;
  QOpenGLVertexArrayObject array_;
  QOpenGLBuffer vertices_{QOpenGLBuffer::VertexBuffer};
  std::vector<QOpenGLBuffer> indices_;
  std::vector<Task> tasks_;
  std::size_t next_ = 0;
};

}  // namespace kinebus::gui
