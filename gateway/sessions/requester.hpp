#pragma once
// Who asks the gateway for something and is answered: a client's conversation, in the job link's frames or in
// HTTP. What a client has under way with the worker is counted here, so that none has more than its share.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/sessions/control.hpp"
#include "gateway/sessions/worker.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

class Requester {
 public:
  /// With its frame just two transfers of USB.
  static constexpr std::size_t kMaxChunk = (128U << 10) - 128;
  static constexpr std::size_t kUploadWindow = 1U << 20;

  /// Both must outlive it.
  Requester(JobStore& store, Worker& worker) : store_(store), worker_(worker) {}
  virtual ~Requester() = default;
  Requester(const Requester&) = delete;
  Requester& operator=(const Requester&) = delete;

  /// 0: it has left, or was not let in.
  virtual ClientId client() const = 0;
  /// `reply` carries the request's number.
  virtual void take_reply(joblink::Reply reply) = 0;

  /// Its stop is an emergency stop: what the machine file says of STOP and heat is not asked.
  virtual bool stop_cuts_heat() const { return true; }

  /// Bytes of an upload are with the worker.
  void owe(std::size_t bytes) { owed_bytes_ += bytes; }
  void paid(std::size_t bytes) { owed_bytes_ -= bytes; }
  /// A text to be filled, with the memory of one that was kept: chunks come by the hundred a second.
  std::string spare_buffer();
  void keep_buffer(std::string&& buffer);
  /// Uploads are those of who began them. The one that began first goes back to the disk when there are too
  /// many.
  void begin_upload(std::uint32_t upload);
  void end_upload(std::uint32_t upload) { std::erase(uploads_, upload); }
  bool owns_upload(std::uint32_t upload) const {
    return std::find(uploads_.begin(), uploads_.end(), upload) != uploads_.end();
  }

 protected:
  std::size_t owed_bytes() const { return owed_bytes_; }
  /// All that are open go on when somebody begins them again.
  void set_uploads_aside();

 private:
  void set_aside(std::uint32_t upload);

  JobStore& store_;
  Worker& worker_;
  std::size_t owed_bytes_ = 0;
  std::vector<std::string> spare_buffers_;
  std::vector<std::uint32_t> uploads_;
};

}  // namespace kinebus
