#pragma once
// The shader programs of the scene.

#include <QOpenGLShaderProgram>
#include <memory>

namespace kinebus::gui {

struct GlPrograms {
  std::unique_ptr<QOpenGLShaderProgram> bodies;   ///< solid bodies and flat grounds, lit
  std::unique_ptr<QOpenGLShaderProgram> lines;    ///< the path as lines of a pixel: while something moves
  std::unique_ptr<QOpenGLShaderProgram> ribbons;  ///< the path as beads of its real width: at rest
  std::unique_ptr<QOpenGLShaderProgram> plain;    ///< lines of one colour: grid, reach
  std::unique_ptr<QOpenGLShaderProgram> sky;      ///< the background's gradient
  /// Empty: all is well; else what the driver says.
  QString build();
};

}  // namespace kinebus::gui
