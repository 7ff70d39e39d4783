#include "gateway/sessions/http/job_stream.hpp"

#include <utility>

namespace kinebus::http {

void JobStream::begin(const std::string& name, std::uint64_t expected_bytes, bool replace,
                      std::function<void()> begun) {
  name_ = name;
  session_.begin_open_ended(name, expected_bytes, replace,
                            [this, begun = std::move(begun)](const joblink::Reply& reply) {
                              if (reply.has_error()) return refuse(reply.error());
                              upload_ = reply.upload().upload_id();
                              begun();
                            });
}

/// A name that is fine, and that another job has.
void JobStream::refuse(const joblink::Problem& problem) {
  const bool taken = problem.code() == joblink::ERROR_NAME && JobStore::check_name(name_).empty();
  session_.refuse(problem, taken ? 409 : 0);
}

void JobStream::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), Requester::kMaxChunk - piece_.size());
    piece_ += bytes.substr(0, count);
    bytes.remove_prefix(count);
    if (piece_.size() == Requester::kMaxChunk) send();
  }
}

void JobStream::send() {
  if (piece_.empty()) return;
  const std::uint64_t offset = sent_;
  sent_ += piece_.size();
  session_.send_chunk(upload_, offset, piece_, [this](const joblink::Reply& reply) {
    if (reply.has_error()) refuse(reply.error());
  });
  piece_.clear();
}

void JobStream::end(std::function<void()> stored) {
  send();
  joblink::ClientMessage commit;
  commit.mutable_upload_commit()->set_upload_id(upload_);
  session_.ask(commit, [this, stored = std::move(stored)](const joblink::Reply& reply) {
    if (reply.has_error()) return refuse(reply.error());
    stored();
  });
}

}  // namespace kinebus::http
