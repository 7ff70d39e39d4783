#pragma once
// What stands on the table as the scene draws it: what the job has printed so far, and what the last one has
// left.

#include <cstdint>
#include <memory>

#include "gui/scene/gl_path.hpp"
#include "gui/scene/printed_body.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

class PrintOnTable {
 public:
  /// `shown`: the path of the job that is looked at; nullptr when that is another one than the status names.
  void follow(const joblink::Status& status, const std::shared_ptr<const ScenePath>& shown);
  /// It was taken off.
  void forget();
  /// The vertex of `shown` up to which it is printed; UINT32_MAX: wholly, or it is another one that was
  /// printed.
  std::uint32_t done_vertex(const std::shared_ptr<const ScenePath>& shown) const {
    return path_ != nullptr && path_ == shown ? done_ : UINT32_MAX;
  }
  const PrintedBody& body() const { return body_; }

 private:
  std::shared_ptr<const ScenePath> path_;  ///< of which something stands there
  std::uint32_t done_ = UINT32_MAX;        ///< vertex
  bool runs_ = false;                      ///< the job, by the newest status that named it
  PrintedBody body_;
};

}  // namespace kinebus::gui
