#include "gui/scene/scene_renderer.hpp"

#include <QMatrix4x4>
#include <QOpenGLBuffer>
#include <QOpenGLFramebufferObjectFormat>
#include <QOpenGLShaderProgram>
#include <QSize>
#include <QString>
#include <QVector3D>
#include <QVector4D>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/scene/finish_look.hpp"

namespace kinebus::gui {
namespace {

/// Stacks of layers overlap by so much, for walls that lean.
constexpr float kStackOverlap = 1.35F;
/// Of what is behind the frame, that much is hidden.
constexpr float kGlass = 0.35F;

std::vector<QVector3D> circle(float radius_mm, float z_mm) {
  constexpr int kPieces = 96;
  std::vector<QVector3D> points;
  for (int i = 0; i < kPieces; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kPieces;
    points.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z_mm);
  }
  return points;
}

}  // namespace

SceneRenderer::Budget SceneRenderer::budget_for(std::string_view name) {
  Budget budget;
  for (const std::string_view software :
       {"llvmpipe", "softpipe", "swrast", "SWR", "Software", "Basic Render"})
    if (name.find(software) != std::string_view::npos) {
      // Two cores draw 30 pictures/s: a bead is 1 us of processor time; smooth edges treble that of a
      // picture.
      budget.quick_lines = 9'000;
      budget.slice_lines = 8'000;
      budget.samples = 2;
      budget.quick_samples = false;
    }
  return budget;
}

QString SceneRenderer::initialise() {
  gl_.initializeOpenGLFunctions();
  if (const auto* name = reinterpret_cast<const char*>(gl_.glGetString(GL_RENDERER)); name != nullptr)
    budget_ = budget_for(name);
  if (QString wrong = programs_.build(); !wrong.isEmpty()) return wrong;
  bodies_.build(gl_);
  empty_.create();
  plain_array_.create();
  plain_array_.bind();
  plain_buffer_.create();
  plain_buffer_.bind();
  plain_buffer_.setUsagePattern(QOpenGLBuffer::StreamDraw);
  gl_.glEnableVertexAttribArray(0);
  gl_.glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(QVector3D), nullptr);
  plain_array_.release();
  return {};
}

void SceneRenderer::release() {
  path_.release();
  bodies_.release();
  plain_buffer_.destroy();
  plain_array_.destroy();
  empty_.destroy();
  programs_ = {};
  shown_ = nullptr;
  quick_ = {};
  rest_ = {};
  begun_ = refined_ = false;
}

void SceneRenderer::set_path(std::shared_ptr<const ScenePath> scene) {
  path_.set(gl_, std::move(scene));
  begun_ = refined_ = false;
}

void SceneRenderer::prepare(Picture& picture, int samples) {
  if (picture.buffer == nullptr || picture.buffer->size() != pixels_ || picture.samples != samples) {
    QOpenGLFramebufferObjectFormat format;
    format.setSamples(samples);
    format.setAttachment(QOpenGLFramebufferObject::CombinedDepthStencil);
    if (shown_ == picture.buffer.get()) shown_ = nullptr;
    picture.buffer = std::make_unique<QOpenGLFramebufferObject>(pixels_, format);
    picture.samples = samples;
  }
  picture.buffer->bind();
  gl_.glViewport(0, 0, pixels_.width(), pixels_.height());
}

void SceneRenderer::draw_quick(const SceneContent& content, QSize pixels) {
  content_ = content;
  pixels_ = pixels;
  begun_ = refined_ = false;
  world_clip_ = content.camera.projection(pixels) * content.camera.view();
  path_.copy_some(gl_, budget_.copy_bytes);
  DrawPlan plan;
  if (path_.ready()) plan = plan_drawing(path_.scene()->levels, path_view(budget_.quick_lines));
  // A path that is small enough has all its beads at once: nothing changes when it comes to rest.
  const bool whole = !plan.thinned && !copying();
  prepare(quick_, whole || budget_.quick_samples ? budget_.samples : 0);
  shown_ = quick_.buffer.get();
  draw_surroundings();
  for (const DrawRange& range : plan.ranges) {
    use(range);
    path_.draw(gl_, range, 0, range.lines.count());
  }
  lines_drawn_ = plan.lines;
  refined_ = whole;
  draw_reach();
  draw_frame();
  draw_trail();
  draw_mark();
  quick_.buffer->release();
}

bool SceneRenderer::refine() {
  if (refined_ || quick_.buffer == nullptr) return true;
  if (!path_.ready()) return false;
  prepare(rest_, budget_.samples);
  if (!begun_) {
    begun_ = true;
    draw_surroundings();
    rest_plan_ = plan_drawing(path_.scene()->levels, path_view(budget_.rest_lines));
    rest_range_ = 0;
    rest_skip_ = 0;
  } else {
    gl_.glEnable(GL_DEPTH_TEST);
  }
  std::size_t left = budget_.slice_lines;
  while (left > 0 && rest_range_ < rest_plan_.ranges.size()) {
    const DrawRange& range = rest_plan_.ranges[rest_range_];
    const auto count =
        static_cast<std::uint32_t>(std::min<std::size_t>(left, range.lines.count() - rest_skip_));
    use(range);
    path_.draw(gl_, range, rest_skip_, count);
    left -= count;
    rest_skip_ += count;
    if (rest_skip_ == range.lines.count()) {
      ++rest_range_;
      rest_skip_ = 0;
    }
  }
  if (rest_range_ == rest_plan_.ranges.size()) {
    draw_reach();
    draw_frame();
    draw_trail();
    draw_mark();
    lines_drawn_ = rest_plan_.lines;
    refined_ = true;
    shown_ = rest_.buffer.get();
  }
  gl_.glFlush();
  QOpenGLFramebufferObject::bindDefault();
  return refined_;
}

void SceneRenderer::present(GLuint target) {
  if (shown_ == nullptr) return;
  gl_.glBindFramebuffer(GL_READ_FRAMEBUFFER, shown_->handle());
  gl_.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  gl_.glBlitFramebuffer(0, 0, shown_->width(), shown_->height(), 0, 0, shown_->width(), shown_->height(),
                        GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl_.glBindFramebuffer(GL_FRAMEBUFFER, target);
}

PathView SceneRenderer::path_view(std::size_t max_lines) const {
  PathView view;
  const QMatrix4x4 frame = content_.figure.part_frame;
  view.clip = world_clip_ * frame;
  view.eye_mm = frame.inverted().map(content_.camera.eye_mm());
  view.mm_per_pixel_at_1mm = content_.camera.mm_per_pixel(pixels_) / content_.camera.distance_mm;
  view.first_layer = content_.first_layer;
  view.last_layer = content_.last_layer;
  view.end_vertex = content_.end_vertex;
  view.done_vertex = content_.done_vertex;
  view.show_remaining = content_.show_remaining;
  view.show_travel = content_.show_travel;
  view.max_lines = max_lines;
  return view;
}

void SceneRenderer::use(const DrawRange& range) {
  // Travel is never a bead: nothing is deposited there.
  bind_path_program(range.style == PathStyle::kTravel ? *programs_.lines : *programs_.ribbons, range);
}

void SceneRenderer::bind_path_program(QOpenGLShaderProgram& program, const DrawRange& range) {
  const PathStyle style = range.style;
  const float stack_mm =
      range.layers > 1 ? kStackOverlap * static_cast<float>(range.layers) * path_.scene()->levels.layer_mm
                       : 0;
  program.bind();
  const PathView view = path_view(0);
  program.setUniformValue("clip", view.clip);
  program.setUniformValue("eye", view.eye_mm);
  program.setUniformValue(
      "half_width", (style == PathStyle::kRemaining ? stack_mm : std::max(content_.bead_mm, stack_mm)) / 2);
  program.setUniformValue("stack", stack_mm > 0);
  program.setUniformValue("pixel_at_1mm", view.mm_per_pixel_at_1mm);
  const QVector3D key =
      content_.figure.part_frame.inverted().mapVector(QVector3D(0.35F, -0.55F, 0.75F)).normalized();
  program.setUniformValue("key", key);
  program.setUniformValue("colouring", static_cast<int>(content_.colouring));
  program.setUniformValue("style", static_cast<int>(style));
  program.setUniformValue("travel_colour", content_.colours.travel);
  program.setUniformValue("remaining_colour", content_.colours.remaining);
  // What is printed is a body as others are: red when one comes close to it.
  const Look near = look_of(Finish::kNear);
  program.setUniformValue("near_colour", QVector4D(content_.colours.dark ? near.dark : near.light,
                                                   content_.figure.close_to_print ? 0.8F : 0.0F));
  program.setUniformValueArray("ramp", colour_ramp(content_.colouring)[0].data(), 9, 3);
}

void SceneRenderer::draw_surroundings() {
  gl_.glDisable(GL_BLEND);
  gl_.glDisable(GL_CULL_FACE);
  gl_.glDepthMask(GL_TRUE);
  gl_.glClear(GL_DEPTH_BUFFER_BIT);
  gl_.glDisable(GL_DEPTH_TEST);
  programs_.sky->bind();
  programs_.sky->setUniformValue("low", content_.colours.sky_low);
  programs_.sky->setUniformValue("high", content_.colours.sky_high);
  empty_.bind();
  gl_.glDrawArrays(GL_TRIANGLES, 0, 3);
  empty_.release();
  gl_.glEnable(GL_DEPTH_TEST);
  gl_.glDepthFunc(GL_LEQUAL);
  if (content_.has_machine) draw_figure();
}

void SceneRenderer::draw_figure() {
  QOpenGLShaderProgram& program = *programs_.bodies;
  program.bind();
  program.setUniformValue("clip", world_clip_);
  program.setUniformValue("eye", content_.camera.eye_mm());
  program.setUniformValue("cover", 1.0F);
  for (const FigurePart& part : content_.figure.parts)
    if ((content_.show_machine && part.finish != Finish::kFixed) || part.finish == Finish::kTable)
      draw_part(part);
  // The bed's grid, every 50 mm, just above the table.
  std::vector<QVector3D> grid;
  const MachineModel& m = content_.model;
  const bool round = m.table_radius_mm > 0;
  const double half_x = round ? m.table_radius_mm : m.x_mm.max,
               half_y = round ? m.table_radius_mm : m.y_mm.max;
  const double low_x = round ? -half_x : m.x_mm.min, low_y = round ? -half_y : m.y_mm.min;
  const auto line = [&](double x0, double y0, double x1, double y1) {
    grid.emplace_back(static_cast<float>(x0), static_cast<float>(y0), 0.1F);
    grid.emplace_back(static_cast<float>(x1), static_cast<float>(y1), 0.1F);
  };
  constexpr int kGrid_mm = 50;
  const auto first = [](double low_mm) { return static_cast<int>(std::ceil(low_mm / kGrid_mm)); };
  for (int i = first(low_x); i * kGrid_mm <= half_x; ++i) {
    const double x = i * kGrid_mm;
    const double y = round ? std::sqrt(std::max(0.0, half_y * half_y - x * x)) : half_y;
    line(x, round ? -y : low_y, x, y);
  }
  for (int i = first(low_y); i * kGrid_mm <= half_y; ++i) {
    const double y = i * kGrid_mm;
    const double x = round ? std::sqrt(std::max(0.0, half_x * half_x - y * y)) : half_x;
    line(round ? -x : low_x, y, x, y);
  }
  const QMatrix4x4 clip = world_clip_ * content_.figure.part_frame;
  draw_plain(grid, GL_LINES, clip, QVector4D(content_.colours.grid, 1));
  draw_plain({{0, 0, 0.4F}, {25, 0, 0.4F}}, GL_LINES, clip, {0.90F, 0.27F, 0.27F, 1});
  draw_plain({{0, 0, 0.4F}, {0, 25, 0.4F}}, GL_LINES, clip, {0.30F, 0.72F, 0.36F, 1});
}

/// With the program of bodies bound.
void SceneRenderer::draw_part(const FigurePart& part) {
  QOpenGLShaderProgram& program = *programs_.bodies;
  const Look look = look_of(part.finish);
  program.setUniformValue("place", part.place);
  program.setUniformValue("normal_matrix", part.place.normalMatrix());
  program.setUniformValue("colour", content_.colours.dark ? look.dark : look.light);
  program.setUniformValue("gloss", look.gloss);
  program.setUniformValue("glow", look.glow);
  bodies_.draw(gl_, part.body);
}

/// The machine's frame is glass: its columns stand in front of legs, table and part. First its depth alone,
/// so that one pane is seen and not a column's far side through its near one.
void SceneRenderer::draw_frame() {
  if (!content_.has_machine || !content_.show_machine) return;
  QOpenGLShaderProgram& program = *programs_.bodies;
  program.bind();
  program.setUniformValue("clip", world_clip_);
  program.setUniformValue("eye", content_.camera.eye_mm());
  program.setUniformValue("cover", kGlass);
  gl_.glEnable(GL_BLEND);
  gl_.glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  for (const bool seen : {false, true}) {
    const auto mask = static_cast<GLboolean>(seen ? GL_TRUE : GL_FALSE);
    gl_.glColorMask(mask, mask, mask, mask);
    for (const FigurePart& part : content_.figure.parts)
      if (part.finish == Finish::kFixed) draw_part(part);
  }
  gl_.glDisable(GL_BLEND);
}

void SceneRenderer::draw_reach() {
  if (!content_.has_machine || !content_.show_reach) return;
  const MachineModel& m = content_.model;
  const QMatrix4x4 clip = world_clip_ * content_.figure.part_frame;
  const QVector4D colour(content_.colours.reach, 0.55F);
  gl_.glEnable(GL_BLEND);
  // The picture stays opaque.
  gl_.glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  const auto low = static_cast<float>(std::max(0.0, m.z_mm.min)), high = static_cast<float>(m.z_mm.max);
  std::vector<QVector3D> uprights;
  if (m.round()) {
    const auto radius = static_cast<float>(m.radius_mm);
    draw_plain(circle(radius, low + 0.2F), GL_LINE_LOOP, clip, colour);
    draw_plain(circle(radius, high), GL_LINE_LOOP, clip, colour);
    const auto ring = circle(radius, 0);
    for (std::size_t i = 0; i < ring.size(); i += 12)
      for (const float z : {low, high}) uprights.emplace_back(ring[i].x(), ring[i].y(), z);
  } else {
    const auto x0 = static_cast<float>(m.x_mm.min), x1 = static_cast<float>(m.x_mm.max);
    const auto y0 = static_cast<float>(m.y_mm.min), y1 = static_cast<float>(m.y_mm.max);
    for (const float z : {low + 0.2F, high})
      draw_plain({{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, GL_LINE_LOOP, clip, colour);
    for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
      for (const float z : {low, high}) uprights.emplace_back(x, y, z);
  }
  draw_plain(uprights, GL_LINES, clip, QVector4D(content_.colours.reach, 0.22F));
  gl_.glDisable(GL_BLEND);
}

/// Over the beads, which are wider than it.
void SceneRenderer::draw_trail() {
  if (content_.trail == nullptr) return;
  gl_.glDisable(GL_DEPTH_TEST);
  draw_plain(*content_.trail, GL_LINES, world_clip_ * content_.figure.part_frame,
             QVector4D(0.86F, 0.10F, 0.72F, 1));
  gl_.glEnable(GL_DEPTH_TEST);
}

/// A pin over the place the user asked for, always in front.
void SceneRenderer::draw_mark() {
  const ScenePath* scene = path_.scene();
  if (scene == nullptr || content_.marked_vertex >= scene->path.size()) return;
  const auto& p = scene->path.points_mm[content_.marked_vertex];
  const QVector3D place = content_.figure.part_frame.map(QVector3D(p[0], p[1], p[2]));
  const float size = content_.camera.mm_per_pixel(pixels_) * 9;
  gl_.glDisable(GL_DEPTH_TEST);
  QOpenGLShaderProgram& program = *programs_.bodies;
  program.bind();
  program.setUniformValue("clip", world_clip_);
  program.setUniformValue("eye", content_.camera.eye_mm());
  program.setUniformValue("gloss", 0.3F);
  program.setUniformValue("glow", 0.4F);
  program.setUniformValue("cover", 1.0F);
  program.setUniformValue("colour", QVector3D(0.93F, 0.20F, 0.42F));
  QMatrix4x4 pin;
  pin.translate(place + QVector3D(0, 0, size * 1.3F));
  pin.scale(size * 1.1F, size * 1.1F, size * 2.6F);
  program.setUniformValue("place", pin);
  program.setUniformValue("normal_matrix", pin.normalMatrix());
  bodies_.draw(gl_, Body::kCone);
  QMatrix4x4 head;
  head.translate(place + QVector3D(0, 0, size * 2.9F));
  head.scale(size * 1.5F);
  program.setUniformValue("place", head);
  program.setUniformValue("normal_matrix", head.normalMatrix());
  bodies_.draw(gl_, Body::kSphere);
  gl_.glEnable(GL_DEPTH_TEST);
}

void SceneRenderer::draw_plain(const std::vector<QVector3D>& points, GLenum mode, const QMatrix4x4& clip,
                               QVector4D colour) {
  if (points.empty()) return;
  programs_.plain->bind();
  programs_.plain->setUniformValue("clip", clip);
  programs_.plain->setUniformValue("colour", colour);
  plain_array_.bind();
  plain_buffer_.bind();
  plain_buffer_.allocate(points.data(), static_cast<int>(points.size() * sizeof(QVector3D)));
  gl_.glDrawArrays(mode, 0, static_cast<GLsizei>(points.size()));
  plain_array_.release();
}

}  // namespace kinebus::gui
