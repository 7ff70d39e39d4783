#pragma once
// The input shapers that machine files and jobs may name.

#include <cstdint>

namespace kinebus {

/// Singer and Seering 1990 (ZV, ZVD and those of higher derivatives, ZVDD, ZVDDD); Singhose, Seering and
/// Singer 1994 (EI); Singhose, Porter and Seering 1997 (2HUMP, 3HUMP); MZV: three pulses within three
/// quarters of a period.
enum class ShaperKind : std::uint8_t { kNone, kZv, kMzv, kZvd, kEi, kTwoHump, kThreeHump, kZvdd, kZvddd };

}  // namespace kinebus
