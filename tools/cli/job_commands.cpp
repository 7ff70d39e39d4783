#include "tools/cli/job_commands.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>

#include "protocol/joblink/job_hash.hpp"
#include "tools/cli/job_watch.hpp"
#include "tools/cli/message_json.hpp"
#include "tools/cli/requests.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using Options = std::shared_ptr<MachineOptions>;

std::string date_words(double unix_s) {
  const auto seconds = static_cast<std::time_t>(unix_s);
  std::tm local{};
  ::localtime_r(&seconds, &local);
  return fmt::format("{:%Y-%m-%d %H:%M}", local);
}

const char* result_words(joblink::JobResult result) {
  switch (result) {
    case joblink::JOB_RUNNING:
      return "running";
    case joblink::JOB_COMPLETE:
      return "complete";
    case joblink::JOB_CANCELLED:
      return "cancelled";
    case joblink::JOB_REFUSED:
      return "refused";
    case joblink::JOB_FAILED:
      return "failed";
    case joblink::JOB_INTERRUPTED:
      return "interrupted";
    default:
      return "?";
  }
}

std::shared_ptr<std::string> named(CLI::App* command, const std::string& what, const std::string& help) {
  auto value = std::make_shared<std::string>();
  command->add_option(what, *value, help)->required();
  return value;
}

void print_jobs(const joblink::JobList& list) {
  for (const joblink::Job& job : list.jobs()) {
    std::string more;
    if (job.has_preflight())
      more += job.preflight().errors() > 0
                  ? fmt::format("  {} errors", job.preflight().errors())
                  : fmt::format("  {}", time_words(job.preflight().motion_s() + job.preflight().dwell_s()));
    if (job.has_last_run()) more += fmt::format("  last run {}", result_words(job.last_run().result()));
    fmt::print("{:>12}  {}{}\n", job.size_bytes(), job.name(), more);
  }
  for (const joblink::PartialUpload& partial : list.partial_uploads())
    fmt::print("{:>12}  {}  half uploaded: {:.0f} %{}\n", partial.size_bytes(), partial.name(),
               100.0 * static_cast<double>(partial.received_bytes()) /
                   static_cast<double>(std::max<std::uint64_t>(partial.size_bytes(), 1)),
               partial.open() ? ", on its way" : "");
}

int print_preflight(const joblink::PreflightResult& result) {
  for (const joblink::JobProblem& p : result.problems())
    fmt::print("{}line {}{}: {}\n", p.error() ? "error: " : "warning: ", p.line(),
               p.column() > 0 ? fmt::format(", column {}", p.column()) : "", p.words());
  const joblink::PreflightSummary& s = result.summary();
  fmt::print("{} lines, {} moves, {} in motion: {} errors, {} warnings\n", s.lines(), result.moves(),
             time_words(s.motion_s() + s.dwell_s()), s.errors(), s.warnings());
  return s.errors() > 0 ? 1 : 0;
}

void print_history(const joblink::History& history) {
  for (const joblink::JobRun& run : history.runs())
    fmt::print("{}  {:11}  {:>12}  {}{}\n", date_words(run.begun_unix_s()), result_words(run.result()),
               time_words(run.duration_s()), run.name(),
               run.first_error().empty() ? "" : "  " + run.first_error());
}

void add_run(CLI::App& app, const Options& options, int& exit_code) {
  auto* run =
      app.add_subcommand("run", "Send a G-code file to the gateway, check it, run it and show its progress");
  const auto file = named(run, "file", "G-code file, or the name of a stored job");
  auto detach = std::make_shared<bool>(false);
  run->add_flag("--detach", *detach, "Return when the job has started");
  run->callback([=, &exit_code] {
    Client client(options->reach, 5, true);
    if (options->force) {
      ClientMessage request;
      request.mutable_take_control()->set_force(true);
      client.ask(std::move(request));
    }
    exit_code = run_job(client, *file, *detach);
  });
  app.add_subcommand("watch", "Show the progress of the running job")->callback([=, &exit_code] {
    Client client(options->reach, 5, true);
    exit_code = watch_job(client);
  });
}

void add_exclude(CLI::App& app, const Options& options) {
  auto* exclude = app.add_subcommand(
      "exclude", "Leave an object of the running print out, or list them: kinebus exclude cube_1");
  auto name = std::make_shared<std::string>();
  exclude->add_option("name", *name, "Of the object; without it all are listed");
  exclude->callback([=] {
    Client client(options->reach);
    if (name->empty()) {
      const joblink::Status status = client.status();
      if (options->json) return fmt::print("{}", to_json_text(status, {"objects"}));
      for (const joblink::PrintObject& object : status.objects())
        fmt::print("{}{}\n", object.name(), object.left_out() ? "  left out" : "");
      return;
    }
    take_control(client, *options);
    ClientMessage request;
    request.mutable_exclude_object()->set_name(*name);
    client.ask(std::move(request));
  });
}

void add_aside(CLI::App& app, const Options& options) {
  app.add_subcommand(
         "aside",
         "Set the job that is held aside: the tool rises and parks, and the machine may be jogged, "
         "heated and its filament changed; resume goes on")
      ->callback([=] {
        Client client(options->reach);
        take_control(client, *options);
        ClientMessage request;
        request.mutable_step_aside();
        client.ask(std::move(request));
      });
  app.add_subcommand("restart", "The gateway begins anew, with the machine file as it is now")->callback([=] {
    Client client(options->reach);
    take_control(client, *options);
    ClientMessage request;
    request.mutable_restart_gateway();
    client.ask(std::move(request));
  });
  auto* filament = app.add_subcommand("filament", "Move the filament as [pause] of the machine file says");
  auto what = std::make_shared<joblink::MoveFilament::What>();
  static const std::map<std::string, joblink::MoveFilament::What> kWays{
      {"unload", joblink::MoveFilament::UNLOAD},
      {"load", joblink::MoveFilament::LOAD},
      {"purge", joblink::MoveFilament::PURGE}};
  filament->add_option("what", *what, "unload, load or purge")
      ->required()
      ->transform(CLI::CheckedTransformer(kWays).description(""));
  filament->callback([=] {
    Client client(options->reach);
    take_control(client, *options);
    ClientMessage request;
    request.mutable_move_filament()->set_what(*what);
    client.ask(std::move(request));
  });
}

void add_store(CLI::App& app, const Options& options, int& exit_code) {
  auto* upload = app.add_subcommand("upload", "Send a G-code file to the gateway's store");
  const auto file = named(upload, "file", "G-code file");
  upload->callback([=] {
    Client client(options->reach);
    upload_job(client, *file);
  });
  app.add_subcommand("jobs", "List the jobs stored on the gateway")->callback([=] {
    Client client(options->reach);
    joblink::JobList all;
    for (bool more = true; more;) {
      ClientMessage request;
      auto& after = *request.mutable_list_jobs();
      if (all.jobs_size() > 0) after.set_after_name(all.jobs(all.jobs_size() - 1).name());
      const joblink::Reply reply = client.ask(std::move(request));
      more = reply.jobs().more() && reply.jobs().jobs_size() > 0;
      all.MergeFrom(reply.jobs());
    }
    if (options->json) return fmt::print("{}", to_json_text(all, {"jobs", "partial_uploads"}));
    print_jobs(all);
  });
  auto* remove = app.add_subcommand("delete", "Delete a stored job");
  const auto name = named(remove, "name", "as 'kinebus jobs' lists it");
  remove->callback([=] {
    Client client(options->reach);
    ClientMessage request;
    request.mutable_delete_job()->set_name(*name);
    client.ask(std::move(request));
  });
  auto* discard =
      app.add_subcommand("discard", "Forget half uploads of this name, which 'kinebus jobs' lists");
  const auto half = named(discard, "name", "as 'kinebus jobs' lists it");
  discard->callback([=] {
    Client client(options->reach);
    const joblink::Reply reply = client.ask(plain(&ClientMessage::mutable_list_jobs));
    for (const joblink::PartialUpload& partial : reply.jobs().partial_uploads()) {
      if (partial.name() != *half) continue;
      ClientMessage request;
      request.mutable_discard_upload()->set_name(partial.name());
      request.mutable_discard_upload()->set_hash(partial.hash());
      request.mutable_discard_upload()->set_size_bytes(partial.size_bytes());
      client.ask(std::move(request));
    }
  });
  auto* check = app.add_subcommand("check", "Check a stored job without moving anything");
  const auto checked = named(check, "name", "as 'kinebus jobs' lists it");
  check->callback([=, &exit_code] {
    Client client(options->reach);
    ClientMessage request;
    request.mutable_check_job()->set_name(*checked);
    const joblink::PreflightResult result = client.ask(std::move(request)).preflight();
    if (options->json) fmt::print("{}", to_json_text(result));
    exit_code = options->json ? result.summary().errors() > 0 : print_preflight(result);
  });
  app.add_subcommand("history", "What ran, and how it ended")->callback([=] {
    Client client(options->reach);
    const joblink::History history = client.ask(plain(&ClientMessage::mutable_get_history)).history();
    if (options->json) return fmt::print("{}", to_json_text(history));
    print_history(history);
  });
}

void add_events(CLI::App& app, const Options& options) {
  auto* events = app.add_subcommand("events", "What has happened since the gateway's start");
  auto alarms = std::make_shared<bool>(false);
  events->add_flag("--alarms", *alarms, "Only alarms");
  events->callback([=] {
    Client client(options->reach);
    std::uint64_t last = 0;
    joblink::EventList all;
    for (bool more = true; more;) {
      ClientMessage request;
      request.mutable_get_events()->set_alarms_only(*alarms);
      request.mutable_get_events()->set_max_events(1000);
      request.mutable_get_events()->set_after_id(last);
      const joblink::Reply reply = client.ask(std::move(request));
      for (const joblink::Event& e : reply.events().events()) {
        last = e.id();
        if (options->json) {
          *all.add_events() = e;
        } else if (!e.words().empty()) {  // a list that has changed is told without words
          fmt::print("{}  {}{}\n", date_words(e.unix_s()), e.words(),
                     e.advice().empty() ? "" : " - " + e.advice());
        }
      }
      more = reply.events().more();
    }
    if (options->json) fmt::print("{}", to_json_text(all, {"events"}));
  });
}

void add_machine_file(CLI::App& app, const Options& options, int& exit_code) {
  auto* machine =
      app.add_subcommand("machine-file", "Show the gateway's machine file, check another, or replace it");
  auto check = std::make_shared<std::string>(), write = std::make_shared<std::string>();
  machine->add_option("--check", *check, "Check this file")->check(CLI::ExistingFile);
  machine->add_option("--write", *write, "Put this file in its place, if it is right")
      ->check(CLI::ExistingFile);
  machine->callback([=, &exit_code] {
    Client client(options->reach);
    if (check->empty() && write->empty()) {
      const joblink::Reply reply = client.ask(plain(&ClientMessage::mutable_read_machine_file));
      fmt::print("{}", reply.machine_file().text());
      return;
    }
    std::ostringstream text;
    text << std::ifstream(check->empty() ? *write : *check, std::ios::binary).rdbuf();
    ClientMessage request;
    if (check->empty())
      request.mutable_write_machine_file()->set_text(text.str());
    else
      request.mutable_check_machine_file()->set_text(text.str());
    const joblink::Reply reply = client.try_ask(std::move(request));
    for (const joblink::Problem& p : reply.machine_file_check().problems())
      fmt::print(stderr, "line {}: {}\n", p.line(), to_words(p));
    if (reply.has_error() && reply.machine_file_check().problems_size() == 0)
      throw ClientError(to_words(reply.error()));
    exit_code = reply.machine_file_check().problems_size() > 0 ? 1 : 0;
    if (exit_code == 0)
      fmt::print("{}\n", check->empty() ? "stored: used from the gateway's next start" : "the file is right");
  });
}

}  // namespace

void add_job_commands(CLI::App& app, const Options& options, int& exit_code) {
  add_run(app, options, exit_code);
  add_exclude(app, options);
  add_aside(app, options);
  add_store(app, options, exit_code);
  add_events(app, options);
  add_machine_file(app, options, exit_code);
}

}  // namespace kinebus
