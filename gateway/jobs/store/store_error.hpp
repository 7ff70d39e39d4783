#pragma once
// What the job store answers when it cannot do what it was asked.

#include <cstdint>
#include <string>

#include "gateway/sentence.hpp"

namespace kinebus {

struct StoreError {
  enum class Kind : std::uint8_t {
    kName,  ///< a name that no job may have, or that is taken
    kNoSuchJob,
    kQuota,  ///< the store's own limit
    kDiskFull,
    kReadOnly,
    kChecksum,  ///< the bytes are not those that were announced
    kOrder,     ///< an upload that is not open, or a piece that does not follow
    kBusy,      ///< somebody else is at it
    kDisk,      ///< anything else that the system reports
  };
  Kind kind{};
  Sentence words;
};

}  // namespace kinebus
