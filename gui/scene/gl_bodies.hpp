#pragma once
// The unit bodies of machine_figure.hpp on the graphics card.

#include <QOpenGLBuffer>
#include <QOpenGLExtraFunctions>
#include <QOpenGLVertexArrayObject>
#include <array>

#include "gui/scene/machine_figure.hpp"

namespace kinebus::gui {

class GlBodies {
 public:
  void build(QOpenGLExtraFunctions& gl);
  void release();
  /// With the caller's program bound.
  void draw(QOpenGLExtraFunctions& gl, Body body);

 private:
  struct Span {
    int first = 0, count = 0;
  };
  std::array<Span, 4> spans_{};
  QOpenGLBuffer buffer_{QOpenGLBuffer::VertexBuffer};
  QOpenGLVertexArrayObject array_;
};

}  // namespace kinebus::gui
