#pragma once
// The 3D scene as a widget: turns what the models know into content for the renderer, and the mouse and keys
// into camera moves.

#include <QElapsedTimer>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLWidget>
#include <QPointF>
#include <QSize>
#include <QTimer>
#include <QWheelEvent>
#include <QWidget>

#include "gui/scene/scene_renderer.hpp"

namespace kinebus::gui {

class SceneView : public QOpenGLWidget {
  Q_OBJECT
 public:
  enum class Look { kDiagonal, kTop, kFront, kRight };
  explicit SceneView(QWidget* parent = nullptr);
  ~SceneView() override;
  /// Must be set before the first widget with OpenGL is made.
  static void choose_format();

  /// What is shown, to be changed by the caller; redraw() afterwards.
  SceneContent& content() { return content_; }
  void redraw();
  void set_path(std::shared_ptr<const ScenePath> scene);
  void look(Look look);
  void fit_machine();
  void fit_part();
  /// Looks at a vertex of the path from near and marks it.
  void show_vertex(std::uint32_t vertex);
  const QString& error() const { return error_; }
  bool at_rest() const { return renderer_.refined() && !dirty_; }
  std::size_t frames() const { return frames_; }
  const SceneRenderer& renderer() const { return renderer_; }

 signals:
  void broken(const QString& why);
  void rested();

 protected:
  void initializeGL() override;
  void paintGL() override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void refine();
  QSize device_pixels() const;
  Box machine_box() const;

  SceneRenderer renderer_;
  SceneContent content_;
  std::shared_ptr<const ScenePath> next_path_;
  bool path_changed_ = false;
  bool dirty_ = true, ready_ = false;
  QTimer settle_;
  QElapsedTimer since_quick_;  ///< newest quick picture
  QPointF last_mouse_;
  QString error_;
  std::size_t frames_ = 0;
};

}  // namespace kinebus::gui
