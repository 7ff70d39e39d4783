#pragma once
// The resume journal on the disk: what the gateway before has left, and what this one notes. A thread writes,
// so that a slow disk never holds up the control loop.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "gateway/io/daemon_part.hpp"
#include "gateway/jobs/journal/journal_state.hpp"

namespace kinebus {

class Gateway;

class JournalFile final : public DaemonPart {
 public:
  /// Reads what is there; a torn end is left out. Empty or unreadable: nothing was noted.
  static journal::State read(const std::filesystem::path& path);

  /// Begins a new file that holds `state`, in place of the old one. `path`'s folder must exist; with a disk
  /// that cannot be written problem() tells, and nothing is noted.
  JournalFile(std::filesystem::path path, const journal::State& state, Gateway& gateway);
  ~JournalFile() override;

  void on_event(const MachineEvent&) override {}
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;

 private:
  class Writer;
  Gateway& gateway_;
  std::unique_ptr<Writer> writer_;
  std::uint64_t handed_ = 0;
  bool waiting_ = false;
  LocalTime now_{0};
};

}  // namespace kinebus
