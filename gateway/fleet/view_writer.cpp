#include "gateway/fleet/view_writer.hpp"

#include <chrono>
#include <utility>
#include <vector>

namespace kinebus::fleet {
namespace {
constexpr auto kTurn = std::chrono::milliseconds{100};
}  // namespace

ViewWriter::ViewWriter(SharedQueue& to) : to_(to), thread_([this] { run(); }) {}

ViewWriter::~ViewWriter() {
  quit_ = true;
  thread_.join();
}

void ViewWriter::show(const MachineView& view) {
  const std::lock_guard lock(busy_);
  waiting_.insert_or_assign(view.machine.name, view);
}

void ViewWriter::run() {
  while (!quit_) {
    write_all();
    std::this_thread::sleep_for(kTurn);
  }
  write_all();
}

void ViewWriter::write_all() {
  std::map<std::string, MachineView> taken;
  {
    const std::lock_guard lock(busy_);
    taken.swap(waiting_);
  }
  if (taken.empty()) return;
  std::vector<MachineView> views;
  views.reserve(taken.size());
  for (const auto& [name, view] : taken) views.push_back(view);
  try {
    const std::lock_guard lock(to_.busy);
    to_.queue.note_machines(views);
  } catch (const DatabaseError&) {
    // Each machine's own turn says that. What has come meanwhile is newer.
    const std::lock_guard lock(busy_);
    waiting_.merge(taken);
  }
}

}  // namespace kinebus::fleet
