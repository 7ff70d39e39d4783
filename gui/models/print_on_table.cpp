#include "gui/models/print_on_table.hpp"

#include <algorithm>

namespace kinebus::gui {

void PrintOnTable::follow(const joblink::Status& status, const std::shared_ptr<const ScenePath>& shown) {
  if (!status.job().empty() && shown != nullptr) {
    path_ = shown;
    done_ = static_cast<std::uint32_t>(shown->path.vertex_at_line(std::max(1u, status.line())));
    // A job that ends from its run has come to its end.
    runs_ = status.state() == joblink::STATE_RUNNING;
  } else if (!status.job().empty() || status.state() == joblink::STATE_HOMING) {
    forget();  // who begins another job, or homes, has taken it off the table
  } else if (runs_) {
    runs_ = false;
    done_ = UINT32_MAX;
  }
  body_.follow(path_ != nullptr ? std::shared_ptr<const ToolPath>(path_, &path_->path) : nullptr, done_);
}

void PrintOnTable::forget() {
  path_.reset();
  done_ = UINT32_MAX;
  runs_ = false;
  body_.clear();
}

}  // namespace kinebus::gui
