#include "gui/scene/gl_bodies.hpp"

#include <QVector3D>

#include <cmath>
#include <numbers>
#include <vector>

#include "gui/scene/gl_offset.hpp"

namespace kinebus::gui {
namespace {

struct Corner {
  QVector3D point, normal;
};
using Mesh = std::vector<Corner>;
constexpr int kSides = 48;

void triangle(Mesh& mesh, const Corner& a, const Corner& b, const Corner& c) {
  mesh.insert(mesh.end(), {a, b, c});
}

void quad(Mesh& mesh, const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  triangle(mesh, a, b, c);
  triangle(mesh, a, c, d);
}

QVector3D on_circle(int i, float radius, float z) {
  const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSides;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

void box(Mesh& mesh) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0F, 1.0F}) {
      QVector3D n, u, v;
      n[axis] = sign;
      u[(axis + 1) % 3] = 0.5F;
      v[(axis + 2) % 3] = 0.5F;
      const QVector3D c = n * 0.5F;
      quad(mesh, {c - u - v, n}, {c + u - v, n}, {c + u + v, n}, {c - u + v, n});
    }
}

/// top 0.5: a cylinder; the cone's wide end is at the top.
void round_body(Mesh& mesh, float bottom_radius) {
  const float slope = 0.5F - bottom_radius;
  for (int i = 0; i < kSides; ++i) {
    const auto normal = [&](int k) { return (on_circle(k, 1, 0) - QVector3D(0, 0, slope)).normalized(); };
    const QVector3D low0 = on_circle(i, bottom_radius, -0.5F), low1 = on_circle(i + 1, bottom_radius, -0.5F);
    const QVector3D high0 = on_circle(i, 0.5F, 0.5F), high1 = on_circle(i + 1, 0.5F, 0.5F);
    quad(mesh, {low0, normal(i)}, {low1, normal(i + 1)}, {high1, normal(i + 1)}, {high0, normal(i)});
    triangle(mesh, {{0, 0, 0.5F}, {0, 0, 1}}, {high0, {0, 0, 1}}, {high1, {0, 0, 1}});
    triangle(mesh, {{0, 0, -0.5F}, {0, 0, -1}}, {low1, {0, 0, -1}}, {low0, {0, 0, -1}});
  }
}

void sphere(Mesh& mesh) {
  constexpr int kRings = 10, kSectors = 20;
  const auto at = [](int ring, int sector) {
    const float polar = std::numbers::pi_v<float> * static_cast<float>(ring) / kRings;
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(sector) / kSectors;
    const QVector3D n(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar));
    return Corner{0.5F * n, n};
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector)
      quad(mesh, at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1), at(ring, sector + 1));
}

}  // namespace

void GlBodies::build(QOpenGLExtraFunctions& gl) {
  Mesh mesh;
  const auto add = [&](Body body, const auto& make) {
    Span& span = spans_[static_cast<std::size_t>(body)];
    span.first = static_cast<int>(mesh.size());
    make();
    span.count = static_cast<int>(mesh.size()) - span.first;
  };
  add(Body::kBox, [&] { box(mesh); });
  add(Body::kCylinder, [&] { round_body(mesh, 0.5F); });
  add(Body::kCone, [&] { round_body(mesh, 0.06F); });
  add(Body::kSphere, [&] { sphere(mesh); });
  array_.create();
  array_.bind();
  buffer_.create();
  buffer_.bind();
  buffer_.allocate(mesh.data(), static_cast<int>(mesh.size() * sizeof(Corner)));
  gl.glEnableVertexAttribArray(0);
  gl.glEnableVertexAttribArray(1);
  gl.glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Corner), nullptr);
  gl.glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Corner), buffer_offset(sizeof(QVector3D)));
  array_.release();
}

void GlBodies::release() {
  buffer_.destroy();
  array_.destroy();
}

void GlBodies::draw(QOpenGLExtraFunctions& gl, Body body) {
  const Span& span = spans_[static_cast<std::size_t>(body)];
  array_.bind();
  gl.glDrawArrays(GL_TRIANGLES, span.first, span.count);
  array_.release();
}

}  // namespace kinebus::gui
