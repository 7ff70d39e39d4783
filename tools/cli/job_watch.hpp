#pragma once
// Sending a job and showing how it goes.

#include <functional>
#include <string>

#include "tools/cli/client.hpp"

namespace kinebus {

/// "1 h 02 min", "3 min 10 s", "12 s".
std::string time_words(double seconds);

/// Until the heater is at its target (within 2 K for 2 s), with progress on stdout. 1: it is to have another
/// one by now, since somebody or a fault has changed it.
int wait_for_heat(Client& client, const std::string& heater, double celsius);

/// Until the heater's measurement, just begun, is over, with progress on stdout; as it is then.
joblink::Heater watch_tuning(Client& client, const std::string& heater);

/// Waits until the machine rests; events are printed. Returns the exit code: 0 when the status then is
/// `good`. The client must be watching.
int wait_until_rest(Client& client, const std::function<bool(const joblink::Status&)>& good);

/// Shows a progress bar until the job ended. 0: complete; 1: not.
int watch_job(Client& client);

/// Sends a file to the gateway's store under its own name; returns that name.
std::string upload_job(Client& client, const std::string& file);

/// Uploads `file` (or takes the stored job of that name), runs it, and watches unless `detach`.
int run_job(Client& client, const std::string& file, bool detach);

}  // namespace kinebus
