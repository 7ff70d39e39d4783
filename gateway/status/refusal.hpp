#pragma once

#include <utility>

#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

/// Why a command was not carried out. Nothing has changed then.
struct Refusal {
  Sentence words;
};

inline Error<Refusal> refused(Sentence words) {
  return Error<Refusal>(Refusal{std::move(words)});
}

}  // namespace kinebus
