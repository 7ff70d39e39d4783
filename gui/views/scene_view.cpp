#include "gui/views/scene_view.hpp"

#include <QKeyEvent>
#include <QMatrix4x4>
#include <QMouseEvent>
#include <QOpenGLContext>
#include <QPointF>
#include <QSize>
#include <QSizeF>
#include <QSurfaceFormat>
#include <QVector3D>
#include <QWheelEvent>
#include <QWidget>

namespace kinebus::gui {
namespace {
/// Nothing has moved for so long, and for as long as three pictures take: the picture at rest begins.
constexpr qint64 kSettle_ms = 140, kSettleLongest_ms = 1500;
}  // namespace

void SceneView::choose_format() {
  QSurfaceFormat format = QSurfaceFormat::defaultFormat();
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setSwapInterval(0);
  QSurfaceFormat::setDefaultFormat(format);
}

SceneView::SceneView(QWidget* parent) : QOpenGLWidget(parent), settle_(this) {
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(240, 180);
  settle_.setSingleShot(true);
  connect(&settle_, &QTimer::timeout, this, &SceneView::refine);
}

SceneView::~SceneView() {
  if (!ready_) return;
  disconnect(context(), nullptr, this, nullptr);  // it ends after this object
  makeCurrent();
  renderer_.release();
  doneCurrent();
}

QSize SceneView::device_pixels() const {
  return (QSizeF(size()) * devicePixelRatioF()).toSize();
}

void SceneView::redraw() {
  dirty_ = true;
  update();
}

void SceneView::set_path(std::shared_ptr<const ScenePath> scene) {
  next_path_ = std::move(scene);
  path_changed_ = true;
  content_.marked_vertex = UINT32_MAX;
  redraw();
}

void SceneView::initializeGL() {
  connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, [this] {
    makeCurrent();
    renderer_.release();
    doneCurrent();
    ready_ = false;
  });
  error_ = renderer_.initialise();
  ready_ = error_.isEmpty();
  path_changed_ = true;
  if (!ready_) emit broken(error_);
}

void SceneView::paintGL() {
  if (!ready_) return;
  if (path_changed_) {
    path_changed_ = false;
    renderer_.set_path(next_path_);
  }
  if (dirty_) {
    dirty_ = false;
    // After a pause the time since the last picture tells nothing.
    const qint64 since_ms = since_quick_.isValid() ? since_quick_.elapsed() : kSettleLongest_ms;
    const qint64 picture_ms = since_ms < kSettleLongest_ms ? since_ms : 0;
    since_quick_.start();
    renderer_.draw_quick(content_, device_pixels());
    if (renderer_.copying()) {
      dirty_ = true;
      update();
    } else if (!renderer_.refined()) {
      settle_.start(static_cast<int>(std::clamp(3 * picture_ms, kSettle_ms, kSettleLongest_ms)));
    }
  }
  renderer_.present(defaultFramebufferObject());
  ++frames_;
  if (at_rest()) emit rested();
}

void SceneView::refine() {
  if (!ready_ || dirty_ || !isVisible()) return;
  makeCurrent();
  const bool whole = renderer_.refine();
  doneCurrent();
  if (whole)
    update();
  else
    settle_.start(0);  // events go first
}

void SceneView::mousePressEvent(QMouseEvent* event) {
  last_mouse_ = event->position();
}

void SceneView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF moved = event->position() - last_mouse_;
  last_mouse_ = event->position();
  const bool pan = (event->buttons() & (Qt::RightButton | Qt::MiddleButton)) != 0 ||
                   (event->modifiers() & Qt::ShiftModifier) != 0;
  if (pan)
    content_.camera.pan(moved, size());
  else if ((event->buttons() & Qt::LeftButton) != 0)
    content_.camera.orbit(static_cast<float>(-moved.x()) * 0.4F, static_cast<float>(moved.y()) * 0.4F);
  redraw();
}

void SceneView::mouseDoubleClickEvent(QMouseEvent*) {
  fit_part();
}

void SceneView::wheelEvent(QWheelEvent* event) {
  content_.camera.zoom(std::pow(0.999F, static_cast<float>(event->angleDelta().y())));
  redraw();
  event->accept();
}

void SceneView::keyPressEvent(QKeyEvent* event) {
  constexpr float kTurn_deg = 5;
  switch (event->key()) {
    case Qt::Key_Left:
      content_.camera.orbit(kTurn_deg, 0);
      break;
    case Qt::Key_Right:
      content_.camera.orbit(-kTurn_deg, 0);
      break;
    case Qt::Key_Up:
      content_.camera.orbit(0, kTurn_deg);
      break;
    case Qt::Key_Down:
      content_.camera.orbit(0, -kTurn_deg);
      break;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      content_.camera.zoom(0.88F);
      break;
    case Qt::Key_Minus:
      content_.camera.zoom(1.14F);
      break;
    case Qt::Key_F:
      fit_part();
      return;
    case Qt::Key_M:
      fit_machine();
      return;
    default:
      QOpenGLWidget::keyPressEvent(event);
      return;
  }
  redraw();
}

void SceneView::look(Look look) {
  Camera& camera = content_.camera;
  switch (look) {
    case Look::kDiagonal:
      camera.azimuth_deg = -32;
      camera.elevation_deg = 24;
      break;
    case Look::kTop:
      camera.azimuth_deg = 0;
      camera.elevation_deg = 89.5F;
      break;
    case Look::kFront:
      camera.azimuth_deg = 0;
      camera.elevation_deg = 0;
      break;
    case Look::kRight:
      camera.azimuth_deg = 90;
      camera.elevation_deg = 0;
      break;
  }
  redraw();
}

Box SceneView::machine_box() const {
  Box box;
  for (const FigurePart& part : content_.figure.parts)
    for (int corner = 0; corner < 8; ++corner) {
      const QVector3D p =
          part.place.map(QVector3D((corner & 1) != 0 ? 0.5F : -0.5F, (corner & 2) != 0 ? 0.5F : -0.5F,
                                   (corner & 4) != 0 ? 0.5F : -0.5F));
      box.add(std::array<float, 3>{p.x(), p.y(), p.z()});
    }
  return box;
}

void SceneView::fit_machine() {
  content_.camera.fit(machine_box(), size());
  redraw();
}

void SceneView::fit_part() {
  Box box;
  const Box part = next_path_ != nullptr ? next_path_->path.bounds_mm : Box{};
  const QMatrix4x4 frame = content_.figure.part_frame;
  const auto add = [&](float x, float y, float z) {
    const QVector3D p = frame.map(QVector3D(x, y, z));
    box.add(std::array<float, 3>{p.x(), p.y(), p.z()});
  };
  if (!part.empty()) {
    for (int corner = 0; corner < 8; ++corner)
      add((corner & 1) != 0 ? part.high_mm[0] : part.low_mm[0],
          (corner & 2) != 0 ? part.high_mm[1] : part.low_mm[1], (corner & 4) != 0 ? part.high_mm[2] : 0);
  } else if (content_.has_machine) {
    const auto r =
        static_cast<float>(content_.model.round() ? content_.model.radius_mm : content_.model.x_mm.max);
    for (const float side : {-r, r}) add(side, side, 0), add(side, -side, r * 0.4F);
  }
  content_.camera.fit(box, size());
  content_.camera.distance_mm *= 1.25F;
  redraw();
}

void SceneView::show_vertex(std::uint32_t vertex) {
  if (next_path_ == nullptr || vertex >= next_path_->path.size()) return;
  const auto& p = next_path_->path.points_mm[vertex];
  content_.marked_vertex = vertex;
  content_.camera.target_mm = content_.figure.part_frame.map(QVector3D(p[0], p[1], p[2]));
  content_.camera.distance_mm = std::min(content_.camera.distance_mm, 220.0F);
  redraw();
}

}  // namespace kinebus::gui
