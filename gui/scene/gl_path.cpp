#include "gui/scene/gl_path.hpp"

#include <algorithm>

#include "gui/scene/gl_offset.hpp"

namespace kinebus::gui {

void GlPath::release() {
  for (QOpenGLBuffer& buffer : indices_) buffer.destroy();
  indices_.clear();
  tasks_.clear();
  next_ = 0;
  vertices_.destroy();
  array_.destroy();
  scene_ = nullptr;
}

void GlPath::set(QOpenGLExtraFunctions& gl, std::shared_ptr<const ScenePath> scene) {
  release();
  scene_ = std::move(scene);
  if (scene_ == nullptr) return;
  array_.create();
  array_.bind();
  const auto add = [&](QOpenGLBuffer& buffer, const void* data, std::size_t bytes) {
    buffer.create();
    buffer.bind();
    buffer.setUsagePattern(QOpenGLBuffer::StaticDraw);
    if (bytes > 0) tasks_.push_back({&buffer, static_cast<const char*>(data), bytes, 0});
  };
  // Each made by itself: copies of a QOpenGLBuffer are the same buffer.
  indices_.reserve(kPathLevels + scene_->levels.travel.size());
  while (indices_.size() < kPathLevels + scene_->levels.travel.size())
    indices_.emplace_back(QOpenGLBuffer::IndexBuffer);
  const auto& points = scene_->shades.vertices;
  add(vertices_, points.data(), points.size() * sizeof(PathVertex));
  gl.glEnableVertexAttribArray(0);
  gl.glEnableVertexAttribArray(1);
  gl.glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(PathVertex), nullptr);
  gl.glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(PathVertex),
                           buffer_offset(offsetof(PathVertex, shade)));
  // Coarse levels first: they are what the first picture shows.
  const auto add_list = [&](std::size_t slot, const std::vector<std::uint32_t>& list) {
    add(indices_[slot], list.data(), list.size() * sizeof(std::uint32_t));
  };
  for (std::size_t k = kPathLevels; k-- > 0;) add_list(k, scene_->levels.work[k]);
  for (std::size_t k = 0; k < scene_->levels.travel.size(); ++k)
    add_list(kPathLevels + k, scene_->levels.travel[k]);
  array_.release();
}

bool GlPath::copy_some(QOpenGLExtraFunctions&, std::size_t bytes) {
  if (scene_ == nullptr) return true;
  array_.bind();
  while (next_ < tasks_.size() && bytes > 0) {
    Task& task = tasks_[next_];
    const std::size_t part = std::min(bytes, task.bytes - task.done);
    task.buffer->bind();
    // Drivers clear it: one at a time.
    if (task.done == 0) task.buffer->allocate(static_cast<int>(task.bytes));
    task.buffer->write(static_cast<int>(task.done), task.data + task.done, static_cast<int>(part));
    task.done += part;
    bytes -= part;
    if (task.done == task.bytes) ++next_;
  }
  array_.release();
  return next_ >= tasks_.size();
}

QOpenGLBuffer& GlPath::indices(const DrawRange& range) {
  return indices_[range.style == PathStyle::kTravel ? kPathLevels + range.level : range.level];
}

void GlPath::draw(QOpenGLExtraFunctions& gl, const DrawRange& range, std::uint32_t skip,
                  std::uint32_t count) {
  array_.bind();
  indices(range).bind();
  const std::size_t offset = (std::size_t{range.lines.first} + skip) * 2 * sizeof(std::uint32_t);
  gl.glDrawElements(GL_LINES, static_cast<GLsizei>(2 * count), GL_UNSIGNED_INT, buffer_offset(offset));
  array_.release();
}

}  // namespace kinebus::gui
