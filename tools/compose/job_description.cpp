#include "tools/compose/job_description.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>
#include "gateway/toml.hpp"

namespace kinebus::compose {
namespace {

[[noreturn]] void refuse(const std::string& path, const toml::source_region& where, const std::string& why) {
  throw std::runtime_error(fmt::format("{}:{}: {}", path, where.begin.line, why));
}

std::optional<Vector> three(const std::string& path, const toml::table& table, const char* key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return {};
  const toml::array* list = node->as_array();
  if (list == nullptr || list->size() != 3)
    refuse(path, node->source(), fmt::format("{}: expected three numbers", key));
  Vector out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = list->get(i)->value<double>();
    if (!value || !std::isfinite(*value))
      refuse(path, node->source(), fmt::format("{}: expected three numbers", key));
    out[static_cast<Eigen::Index>(i)] = *value;
  }
  return out;
}

std::string file(const std::string& path, const toml::table& table, const char* key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return {};
  const auto name = node->value<std::string>();
  if (!name || name->empty()) refuse(path, node->source(), fmt::format("{}: expected a file name", key));
  const auto found = std::filesystem::path(path).parent_path() / *name;
  if (!std::filesystem::is_regular_file(found))
    refuse(path, node->source(), fmt::format("{}: there is no file {}", key, found.string()));
  return found.string();
}

PieceFrame frame(const std::string& path, const toml::table& table) {
  const Vector origin = three(path, table, "origin_mm").value_or(Vector(0, 0, 0));
  const auto euler = three(path, table, "euler_deg"), normal = three(path, table, "normal");
  if (euler && normal) refuse(path, table.source(), "euler_deg and normal: state one of them");
  if (euler) return frame_from_angles(origin, (*euler)[0], (*euler)[1], (*euler)[2]);
  if (!normal) return frame_from_angles(origin, 0, 0, 0);
  if (normal->norm() < 1e-9)
    refuse(path, table.get("normal")->source(), "normal: expected a direction, found 0, 0, 0");
  Solid at;
  at.base.normal = normal->normalized();
  PieceFrame out = frame_of(at);
  out.origin = origin;
  return out;
}

}  // namespace

std::vector<DescribedPiece> read_job_description(const std::string& path) {
  const toml::parse_result parsed = toml::parse_file(path);
  if (!parsed) refuse(path, parsed.error().source(), std::string(parsed.error().description()));
  const toml::table& root = parsed.table();
  const toml::array* list = root.get_as<toml::array>("piece");
  if (list == nullptr || list->empty())
    throw std::runtime_error(path + ": expected [[piece]] tables, in the order of printing");
  static const std::set<std::string, std::less<>> known{"gcode", "mesh", "origin_mm", "euler_deg", "normal"};
  std::vector<DescribedPiece> out;
  for (const toml::node& node : *list) {
    const toml::table* table = node.as_table();
    if (table == nullptr) refuse(path, node.source(), "piece: expected a table");
    for (const auto& [key, value] : *table)
      if (!known.contains(key.str()))
        refuse(path, value.source(),
               fmt::format("{}: unknown key; a piece has gcode, mesh, origin_mm, euler_deg or normal",
                           key.str()));
    DescribedPiece piece{file(path, *table, "gcode"), file(path, *table, "mesh"), frame(path, *table)};
    if (piece.gcode_path.empty())
      refuse(path, table->source(), "gcode: missing; expected the piece's G-code file");
    out.push_back(std::move(piece));
  }
  return out;
}

std::string describe_job(const std::vector<DescribedPiece>& pieces) {
  std::string out =
      "# Pieces in the order of printing: slice them again as you like, then kinebus-compose join.\n";
  for (const DescribedPiece& piece : pieces) {
    const PieceFrame& f = piece.frame;
    out += fmt::format(
        "\n[[piece]]\ngcode = \"{}\"\norigin_mm = [{:.5f}, {:.5f}, {:.5f}]\neuler_deg = [{:.6f}, {:.6f}, "
        "{:.6f}]\n",
        piece.gcode_path, f.origin[0], f.origin[1], f.origin[2], f.i_deg, f.j_deg, f.k_deg);
    if (!piece.mesh_path.empty()) out += fmt::format("mesh = \"{}\"\n", piece.mesh_path);
  }
  return out;
}

}  // namespace kinebus::compose
