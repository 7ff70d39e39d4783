#pragma once
// Draws the scene into pictures of its own. While something moves, every frame is a quick picture of bounded
// cost: a big path has fewer beads, each standing for several layers. At rest the same view is drawn once
// more with all lines and smooth edges, in slices of bounded cost, and replaces the quick picture when it is
// whole. So the caller never waits long.

#include <QMatrix4x4>
#include <QOpenGLBuffer>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <QOpenGLShaderProgram>
#include <QOpenGLVertexArrayObject>
#include <QSize>
#include <QVector3D>
#include <QVector4D>
#include <memory>
#include <string_view>
#include <vector>

#include "gui/scene/camera.hpp"
#include "gui/scene/gl_bodies.hpp"
#include "gui/scene/gl_path.hpp"
#include "gui/scene/gl_programs.hpp"

namespace kinebus::gui {

struct SceneColours {
  QVector3D sky_low, sky_high, ground, grid, reach, text;
  QVector3D travel, remaining;
  bool dark = false;
};

/// All that is seen, but the path itself.
struct SceneContent {
  MachineFigure figure;
  MachineModel model;
  bool has_machine = false;
  bool show_machine = true;
  bool show_reach = true;
  bool show_travel = false;
  bool show_remaining = true;
  PathColouring colouring = PathColouring::kFeed;
  std::uint32_t first_layer = 0, last_layer = UINT32_MAX;
  std::uint32_t done_vertex = UINT32_MAX;    ///< what is made so far; UINT32_MAX: no job runs
  std::uint32_t end_vertex = UINT32_MAX;     ///< shown up to here
  std::uint32_t marked_vertex = UINT32_MAX;  ///< a place that the user asked for
  /// Where the tool went, relative to the part: ends of lines, two and two; nullptr: it is not shown.
  std::shared_ptr<const std::vector<QVector3D>> trail;
  Camera camera;
  SceneColours colours;
  float bead_mm = 0.42F;
};

class SceneRenderer {
 public:
  struct Budget {
    std::size_t quick_lines = 200'000;  ///< in a quick picture
    std::size_t slice_lines = 200'000;  ///< in one slice of the picture at rest
    std::size_t rest_lines = 3'000'000;
    std::size_t copy_bytes = 4'000'000;  ///< to the graphics card for each frame
    int samples = 4;                     ///< of each pixel
    bool quick_samples = true;           ///< in quick pictures of a path that has to be thinned, too
  };
  /// What the driver that calls itself `name` (GL_RENDERER) can be asked for.
  static Budget budget_for(std::string_view name);

  /// With a current context; the budget is the driver's then. Empty: ready; else why not.
  QString initialise();
  void release();
  void set_budget(const Budget& budget) { budget_ = budget; }
  void set_path(std::shared_ptr<const ScenePath> scene);

  /// A quick picture; `pixels` in device pixels.
  void draw_quick(const SceneContent& content, QSize pixels);
  /// One slice more of the picture at rest for what draw_quick drew last. True: whole, and shown by
  /// present().
  bool refine();
  /// Whether present() shows the picture at rest.
  bool refined() const { return refined_; }
  /// True while the path is still on its way to the graphics card: draw again.
  bool copying() const { return !path_.ready() && path_.scene() != nullptr; }
  /// Copies the newest picture to the framebuffer `target`.
  void present(GLuint target);
  std::size_t lines_drawn() const { return lines_drawn_; }  ///< in the newest picture

 private:
  struct Picture {
    std::unique_ptr<QOpenGLFramebufferObject> buffer;
    int samples = 0;  ///< asked for
  };
  void prepare(Picture& picture, int samples);
  void draw_surroundings();
  void draw_figure();
  void draw_part(const FigurePart& part);
  void draw_frame();
  void draw_reach();
  void draw_trail();
  void draw_mark();
  void draw_plain(const std::vector<QVector3D>& points, GLenum mode, const QMatrix4x4& clip,
                  QVector4D colour);
  PathView path_view(std::size_t max_lines) const;
  void bind_path_program(QOpenGLShaderProgram& program, const DrawRange& range);
  void use(const DrawRange& range);

  QOpenGLExtraFunctions gl_;
  GlPrograms programs_;
  GlBodies bodies_;
  GlPath path_;
  QOpenGLVertexArrayObject empty_;
  QOpenGLVertexArrayObject plain_array_;
  QOpenGLBuffer plain_buffer_{QOpenGLBuffer::VertexBuffer};
  Picture quick_, rest_;
  const QOpenGLFramebufferObject* shown_ = nullptr;  ///< of one of the two
  Budget budget_;
  SceneContent content_;
  QSize pixels_;
  QMatrix4x4 world_clip_;
  bool begun_ = false, refined_ = false;
  DrawPlan rest_plan_;
  std::size_t rest_range_ = 0;
  std::uint32_t rest_skip_ = 0;
  std::size_t lines_drawn_ = 0;
};

}  // namespace kinebus::gui
