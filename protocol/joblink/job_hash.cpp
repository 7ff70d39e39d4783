#include "protocol/joblink/job_hash.hpp"

#define XXH_STATIC_LINKING_ONLY  // the state's size
#include <xxhash.h>
#if defined(__x86_64__)
#include <xxh_x86dispatch.h>  // the widest registers that this processor has
#endif

namespace kinebus::joblink {

struct JobHash::State {
  XXH3_state_t sum;
};

JobHash::JobHash() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->sum);
}
JobHash::~JobHash() = default;
JobHash::JobHash(JobHash&&) noexcept = default;
JobHash& JobHash::operator=(JobHash&&) noexcept = default;

void JobHash::add(std::string_view bytes) {
  XXH3_128bits_update(&state_->sum, bytes.data(), bytes.size());
}

std::string JobHash::finish() const {
  XXH128_canonical_t canonical{};
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&state_->sum));
  static_assert(sizeof canonical.digest == kJobHashBytes);
  return {reinterpret_cast<const char*>(canonical.digest), kJobHashBytes};
}

std::string job_hash_of(std::string_view bytes) {
  JobHash sum;
  sum.add(bytes);
  return sum.finish();
}

}  // namespace kinebus::joblink
