#pragma once
// The hash that tells one job's text from another's: XXH3 of 128 bits, as `xxh128sum` prints it.
//
// Both ends of a link take it over every byte of every upload, a small board among them: it costs a third to
// one instruction a byte, SHA-256 without instructions of its own 28. It guards against accidents, not
// against a forger, who would have to be let in as a client first, and may then store what he likes anyway.

#include <memory>
#include <string>
#include <string_view>

namespace kinebus::joblink {

inline constexpr std::size_t kJobHashBytes = 16;

class JobHash {
 public:
  JobHash();
  ~JobHash();
  JobHash(JobHash&&) noexcept;
  JobHash& operator=(JobHash&&) noexcept;
  void add(std::string_view bytes);
  /// kJobHashBytes, the most significant first, of all that was added until now.
  std::string finish() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string job_hash_of(std::string_view bytes);

}  // namespace kinebus::joblink
