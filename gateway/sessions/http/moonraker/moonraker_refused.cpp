// Moonraker's API: methods that its web pages have buttons for, and that Kinebus does not carry out. They are
// refused with the reason, which the pages show.

#include <array>

#include "gateway/sessions/http/moonraker/moonraker.hpp"

namespace kinebus::http {
namespace {

constexpr int kNotImplemented = 501;

void no_queue(const Call& call) {
  call.fail(kNotImplemented, "Kinebus has no queue of its own: start stored jobs one by one");
}
void no_services(const Call& call) {
  call.fail(kNotImplemented,
            "Kinebus neither restarts nor switches off its computer, nor services of it: do that there "
            "(systemctl)");
}
void no_folders(const Call& call) {
  call.fail(kNotImplemented, "the store has no folders");
}
void no_copies(const Call& call) {
  call.fail(kNotImplemented, "stored jobs are not copied or renamed: upload them under the other name");
}
void no_devices(const Call& call) {
  call.fail(kNotImplemented,
            "devices of the computer are not listed: 'kinebus-setup' finds nodes on the bus");
}
void kept_history(const Call& call) {
  call.fail(kNotImplemented, "the history is kept; it forgets its oldest jobs by itself");
}
void no_backups(const Call& call) {
  call.fail(kNotImplemented, "what pages keep is in web-pages.json beside the jobs: copy that file");
}
void no_users(const Call& call) {
  call.fail(kNotImplemented,
            "users and their keys are the gateway's: 'kinebus users'; a key is shown by itself");
}
void no_agents(const Call& call) {
  call.fail(kNotImplemented, "Kinebus has no agents: its own API has what they do (/kinebus/v1)");
}
void no_trial(const Call& call) {
  call.fail(kNotImplemented, "a camera is not tried: what is entered is shown");
}

}  // namespace

std::span<const Method> moonraker_refused_methods() {
  static constexpr std::array kMethods{
      Method{"access.login", "POST", "access/login", no_users},
      Method{"access.logout", "POST", "access/logout", no_users},
      Method{"access.refresh_jwt", "POST", "access/refresh_jwt", no_users},
      Method{"access.get_user", "GET", "access/user", no_users},
      Method{"access.post_user", "POST", "access/user", no_users},
      Method{"access.delete_user", "DELETE", "access/user", no_users},
      Method{"access.user.password", "POST", "access/user/password", no_users},
      Method{"access.users.list", "GET", "access/users/list", no_users},
      Method{"access.get_api_key", "GET", "access/api_key", no_users},
      Method{"access.post_api_key", "POST", "access/api_key", no_users},
      Method{"access.oneshot_token", "GET", "access/oneshot_token", no_users},
      Method{"connection.register_remote_method", nullptr, nullptr, no_agents},
      Method{"connection.send_event", nullptr, nullptr, no_agents},
      Method{"server.extensions.request", "POST", "server/extensions/request", no_agents},
      Method{"server.webcams.test", "POST", "server/webcams/test", no_trial},
      Method{"machine.sudo.info", "GET", "machine/sudo/info", no_services},
      Method{"machine.sudo.password", "POST", "machine/sudo/password", no_services},
      Method{"server.job_queue.post_job", "POST", "server/job_queue/job", no_queue},
      Method{"server.job_queue.delete_job", "DELETE", "server/job_queue/job", no_queue},
      Method{"server.job_queue.pause", "POST", "server/job_queue/pause", no_queue},
      Method{"server.job_queue.start", "POST", "server/job_queue/start", no_queue},
      Method{"server.job_queue.jump", "POST", "server/job_queue/jump", no_queue},
      Method{"server.restart", "POST", "server/restart", no_services},
      Method{"server.logs.rollover", "POST", "server/logs/rollover", no_services},
      Method{"machine.reboot", "POST", "machine/reboot", no_services},
      Method{"machine.shutdown", "POST", "machine/shutdown", no_services},
      Method{"machine.services.restart", "POST", "machine/services/restart", no_services},
      Method{"machine.services.start", "POST", "machine/services/start", no_services},
      Method{"machine.services.stop", "POST", "machine/services/stop", no_services},
      Method{"machine.peripherals.usb", "GET", "machine/peripherals/usb", no_devices},
      Method{"machine.peripherals.serial", "GET", "machine/peripherals/serial", no_devices},
      Method{"machine.peripherals.video", "GET", "machine/peripherals/video", no_devices},
      Method{"machine.peripherals.canbus", "GET", "machine/peripherals/canbus", no_devices},
      Method{"server.files.post_directory", "POST", "server/files/directory", no_folders},
      Method{"server.files.delete_directory", "DELETE", "server/files/directory", no_folders},
      Method{"server.files.move", "POST", "server/files/move", no_copies},
      Method{"server.files.copy", "POST", "server/files/copy", no_copies},
      Method{"server.files.zip", "POST", "server/files/zip", no_copies},
      Method{"server.history.delete_job", "DELETE", "server/history/job", kept_history},
      Method{"server.history.reset_totals", "POST", "server/history/reset_totals", kept_history},
      Method{"server.database.compact", "POST", "server/database/compact", no_backups},
      Method{"server.database.post_backup", "POST", "server/database/backup", no_backups},
      Method{"server.database.delete_backup", "DELETE", "server/database/backup", no_backups},
      Method{"server.database.restore", "POST", "server/database/restore", no_backups},
  };
  return kMethods;
}

}  // namespace kinebus::http
