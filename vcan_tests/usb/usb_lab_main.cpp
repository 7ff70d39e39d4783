// kinebus-usb-lab: the host's side of the USB tests, in the lab guest where device and host are one kernel.
//   sink FOLDER         the device of the bare bulk loop, on a FunctionFS folder
//   bulk MIB            speed of the bare bulk loop
//   speed MIB           upload speed and round trip over the job link
//   print FILE          upload, home, start and watch a job to its end; --pulls N: the cable is pulled N
//   times meanwhile upload FILE         --pulls N: so many uploads' cables are pulled at random moments; each
//   must end bit-identical
// The cable is pulled by taking the gadget off its controller (--udc-file, --udc).

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "protocol/joblink/job_hash.hpp"
#include "vcan_tests/usb/bulk_loop.hpp"
#include "vcan_tests/usb/usb_host.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using namespace joblink;

class TextSource : public UploadSource {
 public:
  explicit TextSource(std::string text) : text_(std::move(text)) {}
  std::size_t read(std::uint64_t offset, std::span<char> buffer) override {
    const std::size_t count =
        std::min(buffer.size(), text_.size() - std::min<std::size_t>(offset, text_.size()));
    std::copy_n(text_.data() + offset, count, buffer.data());
    return count;
  }

 private:
  std::string text_;
};

struct Cable {
  std::string udc_file, udc;
  std::uint32_t pulls = 0;
  void write(const std::string& text) const {
    std::ofstream file(udc_file);
    file << text << "\n";
    file.flush();
  }
  void pull() {
    write("");
    ++pulls;
  }
  void plug() const { write(udc); }
};

class Lab {
 public:
  explicit Lab(std::uint32_t seed) : random(seed), client_(options(seed)), host_(client_) {}

  void turn(std::chrono::milliseconds longest = 5ms) {
    host_.turn(longest);
    while (auto news = client_.next_news()) take(*news);
  }
  template <typename Done>
  void until(const char* what, std::chrono::seconds limit, const Done& done) {
    const LocalTime end = UsbHost::now() + limit;
    while (!done()) {
      if (UsbHost::now() > end)
        throw std::runtime_error(std::string("no ") + what + " in time; last: " + last_words_);
      turn();
    }
  }
  void connect() {
    until("connection", 20s, [&] { return client_.connected(); });
  }
  Reply ask(ClientMessage request) {
    const RequestId id = client_.send(std::move(request));
    until("answer", 60s, [&] { return answers_.count(id) > 0; });
    return answers_[id];
  }
  void must(ClientMessage request) {
    const Reply reply = ask(std::move(request));
    if (reply.has_error()) throw std::runtime_error("refused: " + reply.error().rule());
  }
  /// The cable is pulled at a random moment up to `within` from now, and plugged in again a little later.
  void pull_soon(Cable& cable, std::chrono::microseconds within) {
    wait(std::chrono::microseconds(random() % static_cast<std::uint64_t>(within.count())));
    cable.pull();
    until("news of the pull", 10s, [&] { return !client_.connected(); });
    wait(std::chrono::microseconds(random() % 30'000));
    cable.plug();
  }
  void wait(LocalTime duration) {
    const LocalTime end = UsbHost::now() + duration;
    while (UsbHost::now() < end) turn(1ms);
  }
  void upload(const std::string& name, std::string text) {
    stored_ = failed_ = false;
    UploadRequest request{
        .name = name, .size_bytes = text.size(), .hash = job_hash_of(text), .replace = true};
    client_.upload(std::move(request), std::make_unique<TextSource>(std::move(text)));
  }
  bool stored() const {
    if (failed_) throw std::runtime_error("upload failed: " + last_words_);
    return stored_;
  }
  std::string read_back(const std::string& name, std::size_t size) {
    std::string text;
    while (text.size() < size) {
      ClientMessage request;
      request.mutable_read_job()->set_name(name);
      request.mutable_read_job()->set_offset_bytes(text.size());
      request.mutable_read_job()->set_max_bytes(65'536);
      const Reply reply = ask(std::move(request));
      if (reply.has_error() || reply.job_text().data().empty())
        throw std::runtime_error("cannot read " + name + " back");
      text += reply.job_text().data();
    }
    return text;
  }
  const Status& status() const { return status_; }
  std::mt19937_64 random;

 private:
  static Client::Options options(std::uint32_t seed) {
    Client::Options made;
    made.name = "usb lab";
    made.session_seed = seed ^ 0x5EED5EEDU;
    return made;
  }
  void take(const News& news) {
    if (const auto* answer = std::get_if<Answer>(&news)) answers_[answer->request] = answer->reply;
    if (const auto* status = std::get_if<Status>(&news)) status_ = *status;
    if (const auto* event = std::get_if<Event>(&news)) last_words_ = event->ShortDebugString();
    if (const auto* upload = std::get_if<UploadNews>(&news)) {
      stored_ = stored_ || upload->phase == UploadNews::Phase::kStored;
      failed_ = failed_ || upload->phase == UploadNews::Phase::kFailed;
      if (failed_) last_words_ = upload->error.ShortDebugString();
    }
  }

  Client client_;
  UsbHost host_;
  std::unordered_map<RequestId, Reply> answers_;
  Status status_;
  bool stored_ = false, failed_ = false;
  std::string last_words_;
};

std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  if (text.str().empty()) throw std::runtime_error("cannot read " + path);
  return text.str();
}

double seconds_since(LocalTime begin) {
  return std::chrono::duration<double>(UsbHost::now() - begin).count();
}

std::string random_text(std::mt19937_64& random, std::size_t size) {
  std::string text(size, '\0');
  for (std::size_t i = 0; i < size; ++i)
    text[i] = (i % 64 == 63) ? '\n' : static_cast<char>('0' + random() % 75);
  return text;
}

void speed(Lab& lab, std::size_t mib) {
  std::string text = random_text(lab.random, mib << 20U);
  lab.connect();
  std::vector<double> trips;
  for (int i = 0; i < 200; ++i) {
    const LocalTime begin = UsbHost::now();
    ClientMessage ping;
    ping.mutable_ping();
    lab.must(std::move(ping));
    trips.push_back(seconds_since(begin) * 1e3);
  }
  std::sort(trips.begin(), trips.end());
  std::printf("round trip: median %.2f ms, 95 %% %.2f ms, worst %.2f ms of %zu\n", trips[trips.size() / 2],
              trips[trips.size() * 95 / 100], trips.back(), trips.size());
  const LocalTime begin = UsbHost::now();
  lab.upload("speed.gcode", std::move(text));
  lab.until("stored upload", 200s, [&] { return lab.stored(); });
  std::printf("upload: %.2f MB/s, %zu MiB stored and checked\n",
              static_cast<double>(mib << 20U) / 1e6 / seconds_since(begin), mib);
  if (trips[trips.size() / 2] > 5) throw std::runtime_error("a round trip takes more than 5 ms");
}

void uploads(Lab& lab, Cable& cable, std::uint32_t pulls) {
  lab.connect();
  int uploads = 0;
  for (; cable.pulls < pulls; ++uploads) {
    const std::string text = random_text(lab.random, 300'000 + lab.random() % 1'500'000);
    const std::string name = "u" + std::to_string(uploads % 4) + ".gcode";
    lab.upload(name, text);
    for (std::uint64_t more = 1 + lab.random() % 4; more > 0 && !lab.stored() && cable.pulls < pulls;
         --more) {
      lab.pull_soon(cable, 400ms);
      lab.connect();
    }
    lab.until("stored upload", 60s, [&] { return lab.stored(); });
    if (lab.read_back(name, text.size()) != text)
      throw std::runtime_error("upload " + std::to_string(uploads) + " is not bit-identical");
  }
  std::printf("%u pulls during %d uploads: every upload bit-identical\n", cable.pulls, uploads);
}

void print(Lab& lab, Cable& cable, const std::string& path, std::uint32_t pulls) {
  lab.connect();
  lab.upload("print.gcode", file_text(path));
  lab.until("stored upload", 60s, [&] { return lab.stored(); });
  ClientMessage take;
  take.mutable_take_control();
  lab.must(std::move(take));
  const auto state = [&](State wanted, std::chrono::seconds limit) {
    lab.until("state of the machine", limit, [&] { return lab.status().state() == wanted; });
  };
  ClientMessage up, home, start;
  up.mutable_bring_up();
  lab.must(std::move(up));
  state(STATE_UNHOMED, 60s);
  home.mutable_home();
  lab.must(std::move(home));
  state(STATE_READY, 120s);
  start.mutable_start_job()->set_name("print.gcode");
  lab.must(std::move(start));
  state(STATE_RUNNING, 30s);
  double furthest = 0;
  for (std::uint32_t i = 0; i < pulls; ++i) {
    lab.pull_soon(cable, 300ms);
    lab.connect();
    const double progress = lab.status().progress();
    furthest = std::max(furthest, progress);
  }
  state(STATE_READY, 300s);
  ClientMessage history;
  history.mutable_get_history()->set_max_runs(1);
  const Reply reply = lab.ask(std::move(history));
  if (reply.history().runs_size() != 1 || reply.history().runs(0).result() != JOB_COMPLETE)
    throw std::runtime_error("the print did not end complete: " + reply.ShortDebugString());
  std::printf("%u pulls during the print: complete in %.1f s\n", cable.pulls,
              reply.history().runs(0).duration_s());
}

int run(int argc, char** argv) {
  std::string file;
  Cable cable;
  std::size_t mib = 8;
  std::uint32_t pulls = 0, seed = 1;
  CLI::App app("The host's side of the USB tests");
  app.require_subcommand(1);
  app.add_option("--udc-file", cable.udc_file);
  app.add_option("--udc", cable.udc);
  app.add_option("--seed", seed);
  auto* speed_command = app.add_subcommand("speed");
  speed_command->add_option("mib", mib);
  auto* bulk_command = app.add_subcommand("bulk");
  bulk_command->add_option("mib", mib);
  auto* sink_command = app.add_subcommand("sink");
  sink_command->add_option("folder", file)->required();
  auto* upload_command = app.add_subcommand("upload");
  auto* print_command = app.add_subcommand("print");
  print_command->add_option("file", file)->required();
  for (auto* command : {upload_command, print_command}) command->add_option("--pulls", pulls);
  CLI11_PARSE(app, argc, argv);
  if (bulk_command->parsed()) return bulk_loop(mib);
  if (sink_command->parsed()) return bulk_sink(file);
  Lab lab(seed);
  if (speed_command->parsed()) speed(lab, mib);
  if (upload_command->parsed()) uploads(lab, cable, pulls);
  if (print_command->parsed()) print(lab, cable, file, pulls);
  return 0;
}

}  // namespace
}  // namespace kinebus

int main(int argc, char** argv) try { return kinebus::run(argc, argv); } catch (const std::exception& error) {
  std::fprintf(stderr, "FAILED: %s\n", error.what());
  return 1;
}
