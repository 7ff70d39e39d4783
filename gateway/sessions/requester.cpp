#include "gateway/sessions/requester.hpp"

#include <utility>

namespace kinebus {
namespace {
/// Open at once, of one client; it sends one after the other.
constexpr std::size_t kMaxUploads = 2;
}  // namespace

/// It goes on when somebody begins it again.
void Requester::set_aside(std::uint32_t upload) {
  worker_.post([&store = store_, upload] { store.abort(upload, false); }, [] {});
  end_upload(upload);
}

void Requester::set_uploads_aside() {
  while (!uploads_.empty()) set_aside(uploads_.front());
}

void Requester::begin_upload(std::uint32_t upload) {
  if (uploads_.size() >= kMaxUploads) set_aside(uploads_.front());
  uploads_.push_back(upload);
}

std::string Requester::spare_buffer() {
  if (spare_buffers_.empty()) return {};
  std::string buffer = std::move(spare_buffers_.back());
  spare_buffers_.pop_back();
  return buffer;
}

void Requester::keep_buffer(std::string&& buffer) {
  if (spare_buffers_.size() < kUploadWindow / kMaxChunk) spare_buffers_.push_back(std::move(buffer));
}

}  // namespace kinebus
