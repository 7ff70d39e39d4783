#pragma once
// multipart/form-data (RFC 7578) as it comes, sans-IO: heads of parts whole, their data in pieces. Holds back
// no more than a boundary's length of data.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinebus::http {

class Multipart {
 public:
  static constexpr std::size_t kMaxPartHead = 4096;
  static constexpr int kMaxParts = 32;
  enum class Step : std::uint8_t {
    kMore,     ///< more bytes are needed
    kPart,     ///< a part begins: name(), file_name()
    kData,     ///< data(), until the next call of anything
    kPartEnd,  ///< the part is whole
    kEnd,      ///< the closing boundary has come; what follows it is of no meaning
    kBad,      ///< why(); nothing can be read after it
  };

  explicit Multipart(std::string_view boundary);
  void add(std::string_view bytes);
  Step next();

  const std::string& name() const { return name_; }
  /// Empty: the part is no file.
  const std::optional<std::string>& file_name() const { return file_name_; }
  std::string_view data() const { return std::string_view(buffer_).substr(0, spent_); }
  const char* why() const { return why_; }
  bool ended() const { return state_ == State::kEnded; }
  std::size_t held_bytes() const { return buffer_.size(); }

 private:
  enum class State : std::uint8_t { kPreamble, kAfterBoundary, kHead, kData, kEnded, kBad };
  Step bad(const char* why);
  Step after_boundary();
  Step head();
  Step piece();
  const char* read_head(std::string_view lines);

  std::string delimiter_;  ///< CR LF, two dashes, the boundary
  std::string buffer_;
  std::size_t spent_ = 0;  ///< of the buffer's front, told already
  State state_ = State::kPreamble;
  int parts_ = 0;
  std::string name_;
  std::optional<std::string> file_name_;
  const char* why_ = "";
};

/// The boundary in a Content-Type of multipart/form-data; nullopt: it is another type, or the boundary is
/// none.
std::optional<std::string> boundary_of(std::string_view content_type);

}  // namespace kinebus::http
