#pragma once
// Values that the outside may have got wrong: a caller has to look at them.

#include <tl/expected.hpp>

namespace kinebus {
template <typename T, typename E>
using Result = tl::expected<T, E>;
template <typename E>
using Error = tl::unexpected<E>;
}  // namespace kinebus
