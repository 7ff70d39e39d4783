#include "gui/scene/gl_programs.hpp"

#include <QByteArray>
#include <QOpenGLShader>
#include <QString>

namespace kinebus::gui {
namespace {

constexpr const char* kBodyVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 place;
uniform mat4 clip;
uniform mat3 normal_matrix;
uniform vec3 eye;
out vec3 facing;
out vec3 to_eye;
void main() {
  vec4 world = place * vec4(position, 1.0);
  facing = normalize(normal_matrix * normal);
  to_eye = eye - world.xyz;
  gl_Position = clip * world;
})";

// Most of a software rasteriser's time goes here: one root, no power. Normals of neighbouring corners are so
// near each other that what lies between them has length 1 within 0.5 %.
constexpr const char* kBodyFragment = R"(#version 330 core
in vec3 facing;
in vec3 to_eye;
uniform vec3 colour;
uniform float gloss;
uniform float glow;
uniform float cover;
out vec4 pixel;
const vec3 key = vec3(0.35221, -0.55347, 0.75473);
void main() {
  vec3 n = dot(facing, to_eye) < 0.0 ? -facing : facing;
  float light = 0.50 + 0.14 * n.z + 0.46 * max(dot(n, key), 0.0);
  vec3 between = key + to_eye * inversesqrt(dot(to_eye, to_eye));
  float shine = max(dot(n, between), 0.0);
  shine = shine * shine / dot(between, between);
  shine *= shine;
  shine *= shine;
  float shine16 = shine * shine;
  shine = shine16 * shine16 * shine * gloss;
  pixel = vec4(colour * mix(light, 1.15, glow) + shine, cover);
})";

// shade: feed, layer, margin, feature in 0 .. 1. style 0: work, 1: travel, 2: not made yet.
constexpr const char* kPathCommon = R"(
uniform mat4 clip;
uniform int colouring;
uniform int style;
uniform vec3 ramp[9];
uniform vec3 travel_colour;
uniform vec3 remaining_colour;
uniform vec4 near_colour;
vec3 shade_colour(vec4 shade) {
  if (style == 1) return travel_colour;
  float t = (colouring == 0 ? shade.x : colouring == 1 ? shade.y : colouring == 4 ? shade.w : shade.z) * 8.0;
  int i = int(min(t, 7.0));
  vec3 c = mix(ramp[i], ramp[i + 1], clamp(t - float(i), 0.0, 1.0));
  return style == 2 ? mix(remaining_colour, c, 0.16) : mix(c, near_colour.rgb, near_colour.a);
}
)";

constexpr const char* kLineVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 shade;
out vec3 colour;
void main() {
  colour = shade_colour(shade);
  gl_Position = clip * vec4(position, 1.0);
})";

constexpr const char* kLineFragment = R"(#version 330 core
in vec3 colour;
out vec4 pixel;
void main() { pixel = vec4(colour, 1.0); }
)";

constexpr const char* kRibbonVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 shade;
out vec3 vertex_at;
out vec3 vertex_colour;
void main() {
  vertex_colour = shade_colour(shade);
  vertex_at = position;
  gl_Position = vec4(position, 1.0);
})";

// A bead seen from anywhere: a strip that faces the eye, lit as if it were round. A stack of layers is
// less round.
constexpr const char* kRibbonGeometry = R"(#version 330 core
layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;
in vec3 vertex_at[];
in vec3 vertex_colour[];
uniform mat4 clip;
uniform vec3 eye;
uniform float half_width;
uniform float pixel_at_1mm;
out vec3 colour;
out float across;
flat out vec3 side_axis;
flat out vec3 face_axis;
void main() {
  vec3 a = vertex_at[0], b = vertex_at[1];
  vec3 d = b - a;
  float l = length(d);
  if (l < 1e-6) return;
  d /= l;
  vec3 view = eye - 0.5 * (a + b);
  float distance = length(view);
  view /= distance;
  vec3 side = cross(d, view);
  float s = length(side);
  if (s < 1e-4) return;
  side /= s;
  float width = max(half_width, 0.55 * distance * pixel_at_1mm);
  side_axis = side;
  face_axis = normalize(cross(side, d));
  if (dot(face_axis, view) < 0.0) face_axis = -face_axis;
  a -= d * width * 0.35;
  b += d * width * 0.35;
  colour = vertex_colour[1];
  across = -1.0; gl_Position = clip * vec4(a - side * width, 1.0); EmitVertex();
  across = 1.0;  gl_Position = clip * vec4(a + side * width, 1.0); EmitVertex();
  across = -1.0; gl_Position = clip * vec4(b - side * width, 1.0); EmitVertex();
  across = 1.0;  gl_Position = clip * vec4(b + side * width, 1.0); EmitVertex();
  EndPrimitive();
})";

constexpr const char* kRibbonFragment = R"(#version 330 core
in vec3 colour;
in float across;
flat in vec3 side_axis;
flat in vec3 face_axis;
uniform vec3 key;
uniform bool stack;
out vec4 pixel;
void main() {
  float bend = stack ? 0.45 * across : across;
  vec3 n = side_axis * bend + face_axis * sqrt(max(0.0, 1.0 - bend * bend));
  float light = 0.52 + 0.62 * max(dot(n, key), 0.0);
  pixel = vec4(colour * light, 1.0);
})";

constexpr const char* kPlainVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip;
void main() { gl_Position = clip * vec4(position, 1.0); }
)";

constexpr const char* kPlainFragment = R"(#version 330 core
uniform vec4 colour;
out vec4 pixel;
void main() { pixel = colour; }
)";

// One triangle over the whole picture, without a buffer.
constexpr const char* kSkyVertex = R"(#version 330 core
out float height;
void main() {
  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  height = 0.5 + 0.5 * p.y;
  gl_Position = vec4(p, 0.0, 1.0);
})";

constexpr const char* kSkyFragment = R"(#version 330 core
in float height;
uniform vec3 low;
uniform vec3 high;
out vec4 pixel;
void main() { pixel = vec4(mix(low, high, clamp(height, 0.0, 1.0)), 1.0); }
)";

QString build_one(std::unique_ptr<QOpenGLShaderProgram>& program, const QByteArray& vertex,
                  const QByteArray& fragment, const QByteArray& geometry = {}) {
  program = std::make_unique<QOpenGLShaderProgram>();
  const bool built =
      program->addShaderFromSourceCode(QOpenGLShader::Vertex, vertex) &&
      (geometry.isEmpty() || program->addShaderFromSourceCode(QOpenGLShader::Geometry, geometry)) &&
      program->addShaderFromSourceCode(QOpenGLShader::Fragment, fragment) && program->link();
  return built ? QString() : program->log();
}

}  // namespace

QString GlPrograms::build() {
  const QByteArray version = "#version 330 core\n";
  const auto path_vertex = [&](const char* main) { return version + kPathCommon + main; };
  QString wrong;
  wrong += build_one(bodies, kBodyVertex, kBodyFragment);
  wrong += build_one(lines, path_vertex(kLineVertex), kLineFragment);
  wrong += build_one(ribbons, path_vertex(kRibbonVertex), kRibbonFragment, kRibbonGeometry);
  wrong += build_one(plain, kPlainVertex, kPlainFragment);
  wrong += build_one(sky, kSkyVertex, kSkyFragment);
  return wrong;
}

}  // namespace kinebus::gui
