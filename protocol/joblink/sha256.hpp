#pragma once
// SHA-256 of a text in pieces.

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace kinebus::joblink {

inline constexpr std::size_t kSha256Bytes = 32;

class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  void add(std::string_view bytes);
  /// 32 bytes; nothing may be added afterwards.
  std::string finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256_of(std::string_view bytes);
/// "9f86d0...": as people write it.
std::string to_hex(std::string_view bytes);

}  // namespace kinebus::joblink
