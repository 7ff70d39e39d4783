#include "tools/compose/mesh.hpp"

#include <Eigen/Geometry>
#include <fstream>
#include <stdexcept>

namespace kinebus::compose {

Box bounds(const TriangleMesh& mesh) {
  if (mesh.points.empty()) return {};
  Box box{mesh.points.front(), mesh.points.front()};
  for (const Vector& p : mesh.points) box.low = box.low.cwiseMin(p), box.high = box.high.cwiseMax(p);
  return box;
}

void write_stl(const TriangleMesh& mesh, const std::string& path) {
  std::ofstream out(path, std::ios::binary);
  std::array<char, 80> header{};
  out.write(header.data(), header.size());
  const auto count = static_cast<std::uint32_t>(mesh.faces.size());
  const auto put = [&](const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
  put(count);
  for (const auto& face : mesh.faces) {
    const Vector &a = mesh.points[face[0]], &b = mesh.points[face[1]], &c = mesh.points[face[2]];
    for (const Vector& v : {Vector((b - a).cross(c - a).normalized()), a, b, c})
      for (int i = 0; i < 3; ++i) put(static_cast<float>(v[i]));
    put(std::uint16_t{0});
  }
  if (!out.flush()) throw std::runtime_error(path + ": the STL file could not be written");
}

}  // namespace kinebus::compose
