#pragma once
// The machine's bed: which mesh is in force, those that are kept by name, and what levelling commands do to
// them. Commands come at rest.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/jobs/journal/journal_state.hpp"
#include "gateway/kinematics/levelled.hpp"
#include "gateway/result.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/event_queue.hpp"

namespace kinebus {

class BedLevel {
 public:
  /// All must outlive this. `unix_s_at_zero`: wall time at BusTime 0.
  BedLevel(const MachineDescription& machine, LevelledKinematics& kinematics, journal::Queue& journal,
           EventQueue& events, double unix_s_at_zero);

  /// What the gateway before has left. A mesh of another geometry is kept, and not in force.
  void take_up(BusTime now, const journal::State& state);

  /// `touched`: where the probe did since kBegin, table coordinates. Refused: nothing has changed, but for
  /// kEnd, after which no mesh is in force.
  Result<void, Sentence> carry_out(BusTime now, const canonical::Mesh& command,
                                   std::span<const Vector3> touched, std::uint32_t line);
  /// Whether poses may mean another place after it.
  static bool moves_poses(const canonical::Mesh& command);

  /// While a job is read again: as it was then. Without heights: none.
  void put(const MeshGrid& grid);
  /// As before that: the job does not go on.
  void put_back();

  /// nullptr: none is in force.
  const MeshGrid* in_force() const { return levels_.mesh() ? &levels_.mesh()->grid() : nullptr; }
  const std::string& name() const { return name_; }
  /// Of this machine.
  const std::vector<journal::Mesh>& kept() const { return kept_; }
  bool fits(const journal::Mesh& mesh) const { return mesh.geometry == geometry_; }

 private:
  using Done = Result<void, Sentence>;
  Done measured(BusTime now, const canonical::Mesh& command, std::span<const Vector3> touched,
                std::uint32_t line);
  Done turn_on(BusTime now, const canonical::Mesh& command, std::uint32_t line);
  Done change(MeshGrid grid);
  void tell(BusTime now, std::uint32_t line);
  void use(std::string name, const MeshGrid& grid);
  void turn_off();
  void keep(journal::Mesh mesh);
  const journal::Mesh* find(const std::string& name) const;
  std::optional<Sentence> wrong(const MeshGrid& grid) const;

  const MachineDescription& machine_;
  LevelledKinematics& levels_;
  journal::Queue& journal_;
  EventQueue& events_;
  double unix_s_at_zero_;
  std::string identity_;
  std::uint64_t geometry_;
  std::vector<journal::Mesh> kept_;  ///< the one measured last at the end
  std::string name_;                 ///< of the one in force, or the last that was
  bool on_ = false;                  ///< it is in force
};

}  // namespace kinebus
