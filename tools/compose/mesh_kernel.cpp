#include "tools/compose/mesh_kernel.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace kinebus::compose {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

Mesh to_cgal(const TriangleMesh& mesh) {
  Mesh out;
  std::vector<Mesh::Vertex_index> index;
  index.reserve(mesh.points.size());
  for (const Vector& p : mesh.points) index.push_back(out.add_vertex(Point(p[0], p[1], p[2])));
  for (const auto& face : mesh.faces) out.add_face(index[face[0]], index[face[1]], index[face[2]]);
  return out;
}

TriangleMesh from_cgal(Mesh& mesh) {
  mesh.collect_garbage();
  TriangleMesh out;
  for (const auto vertex : mesh.vertices()) {
    const Point& p = mesh.point(vertex);
    out.points.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : mesh.faces()) {
    std::array<std::uint32_t, 3> corners{};
    std::size_t i = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      if (i < 3) corners[i++] = vertex.idx();
    out.faces.push_back(corners);
  }
  return out;
}

int fill_holes(Mesh& mesh) {
  std::vector<Mesh::Halfedge_index> cycles;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  for (const auto edge : cycles) {
    std::vector<Mesh::Face_index> patch;
    pmp::triangulate_hole(mesh, edge, std::back_inserter(patch));
  }
  return static_cast<int>(cycles.size());
}

int crossings(const Mesh& mesh) {
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  return static_cast<int>(pairs.size());
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && std::equal(end.rbegin(), end.rend(), text.rbegin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(b)) == a;
         });
}

}  // namespace

std::string Repair::words() const {
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  if (duplicate_points > 0)
    add(fmt::format("{} duplicate or unused points and faces removed", duplicate_points));
  if (holes_filled > 0) add(fmt::format("{} holes filled", holes_filled));
  if (self_intersections > 0) add(fmt::format("{} pairs of crossing faces resolved", self_intersections));
  if (turned) add("faces turned outward");
  return out.empty() ? "nothing to repair" : out;
}

std::pair<TriangleMesh, Repair> close_mesh(const std::vector<Vector>& given,
                                           std::vector<std::vector<std::size_t>> polygons,
                                           const std::string& what) {
  Repair repair;
  std::vector<Point> points;
  points.reserve(given.size());
  for (const Vector& p : given) {
    if (!p.allFinite()) throw std::runtime_error(what + ": a coordinate is not a finite number");
    points.emplace_back(p[0], p[1], p[2]);
  }
  if (polygons.empty()) throw std::runtime_error(what + ": the file holds no faces");
  const std::size_t faces_before = polygons.size();
  pmp::repair_polygon_soup(points, polygons);
  repair.duplicate_points = static_cast<int>(faces_before - polygons.size());
  pmp::orient_polygon_soup(points, polygons);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  pmp::triangulate_faces(mesh);
  pmp::stitch_borders(mesh);
  repair.holes_filled = fill_holes(mesh);
  pmp::remove_degenerate_faces(mesh);
  if (!CGAL::is_closed(mesh)) throw std::runtime_error(what + ": the surface cannot be closed to a volume");
  repair.self_intersections = crossings(mesh);
  if (repair.self_intersections > 0) {
    pmp::experimental::remove_self_intersections(mesh);
    if (!CGAL::is_closed(mesh) || crossings(mesh) > 0)
      throw std::runtime_error(fmt::format(
          "{}: {} pairs of faces cross each other and could not be resolved; unite the bodies in the "
          "program that drew the part",
          what, repair.self_intersections));
  }
  if (!pmp::is_outward_oriented(mesh)) {
    pmp::orient_to_bound_a_volume(mesh);
    repair.turned = true;
  }
  return {from_cgal(mesh), repair};
}

std::pair<TriangleMesh, Repair> read_mesh(const std::string& path) {
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  bool read = false;
  if (ends_with(path, ".stl")) {
    read = CGAL::IO::read_STL(path, points, polygons, CGAL::parameters::verbose(false));
  } else if (ends_with(path, ".obj")) {
    read = CGAL::IO::read_OBJ(path, points, polygons, CGAL::parameters::verbose(false));
  } else {
    throw std::runtime_error(path + ": the ending must be .stl, .obj or .3mf");
  }
  if (!read) throw std::runtime_error(path + ": not a readable STL or OBJ file");
  std::vector<Vector> converted;
  converted.reserve(points.size());
  for (const auto& p : points) converted.emplace_back(p.x(), p.y(), p.z());
  return close_mesh(converted, std::move(polygons), path);
}

Halves cut(const TriangleMesh& mesh, const Plane& plane) {
  const Vector n = plane.normal;
  const auto side = [&](double sign) {
    Mesh half = to_cgal(mesh);
    // CGAL keeps the negative side of the plane that it is given.
    const Kernel::Plane_3 keep(sign * n[0], sign * n[1], sign * n[2], -sign * plane.height);
    pmp::clip(half, keep, CGAL::parameters::clip_volume(true));
    pmp::remove_degenerate_faces(half);
    return from_cgal(half);
  };
  return {side(1), side(-1)};
}

TriangleMesh unite(const TriangleMesh& a, const TriangleMesh& b) {
  Mesh left = to_cgal(a), right = to_cgal(b), out;
  if (!pmp::corefine_and_compute_union(left, right, out))
    throw std::runtime_error("the union of two bodies is not a closed surface");
  return from_cgal(out);
}

double volume_mm3(const TriangleMesh& mesh) {
  return mesh.faces.empty() ? 0 : pmp::volume(to_cgal(mesh));
}

std::vector<TriangleMesh> bodies(const TriangleMesh& mesh) {
  std::vector<Mesh> parts;
  Mesh whole = to_cgal(mesh);
  pmp::split_connected_components(whole, parts);
  std::vector<TriangleMesh> out;
  out.reserve(parts.size());
  for (Mesh& part : parts) out.push_back(from_cgal(part));
  return out;
}

}  // namespace kinebus::compose
