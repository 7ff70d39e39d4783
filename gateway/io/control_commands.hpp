#pragma once
// What each request of the local socket does: one table from the word to the gateway's method.

#include <nlohmann/json_fwd.hpp>

#include "gateway/io/job_files.hpp"
#include "gateway/machine/gateway.hpp"

namespace kinebus {

/// Carries a request out. Returns the members of the reply ("ok", and "error" or the answer). Upload and
/// watch are the server's own. Throws nothing; a request that is not understood is answered with the reason.
nlohmann::json carry_out(const nlohmann::json& request, Gateway& gateway, JobFolder& jobs);

}  // namespace kinebus
