// kinebus-usb-desktop: the desktop program's own link, session and uploads, without its windows, on a USB
// device that is a daemon with nodes in the same guest. It finds the gateway by hot-plug, uploads, starts a
// job and watches it to its end, while the cable is pulled again and again (the gadget is taken off its
// controller: --udc-file, --udc).

#include <CLI/CLI.hpp>
#include <QCoreApplication>
#include <QDeadlineTimer>
#include <QElapsedTimer>
#include <QFile>
#include <QTemporaryDir>
#include <cstdio>
#include <fstream>
#include <functional>
#include <random>
#include <stdexcept>

#include "gui/link/gateway_finder.hpp"
#include "gui/link/link.hpp"
#include "gui/session/job_download.hpp"
#include "gui/session/job_upload.hpp"
#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {

struct Options {
  std::string udc_file, udc;
  std::uint32_t seed = 1;
  int upload_pulls = 2, print_pulls = 2, laps = 6;
};

class Desktop {
 public:
  explicit Desktop(Options options) : options_(std::move(options)), random_(options_.seed) {
    QObject::connect(&session_, &Session::refused, &session_,
                     [this](const QString& words) { trouble_ = words; });
    QObject::connect(&session_, &Session::status_changed, &session_, [this] {
      ++statuses_;
      ran_ = ran_ || session_.status().state() == joblink::STATE_RUNNING;
    });
  }

  void connect() {
    until("gateway on USB", [this] { return usb() != nullptr; });
    const FoundGateway gateway = *usb();
    session_.connect_to([this, gateway] { return finder_.link_to(gateway); }, gateway.title);
    until("conversation", [this] { return session_.connected() && session_.machine().joints_size() > 0; });
    std::printf("found by hot-plug: %s, %s\n", qPrintable(gateway.title.said()),
                qPrintable(gateway.detail.said()));
  }

  /// Uploads whose cables are pulled at random places; all of them must be bit-identical on the gateway.
  void uploads() {
    int pulls = 0, uploads = 0;
    for (; pulls < options_.upload_pulls; ++uploads) {
      const QByteArray text = some_text(200'000 + static_cast<int>(random_() % 400'000));
      const QString name = QStringLiteral("u%1.gcode").arg(uploads % 4);
      JobUpload& upload = *session_.upload(file(name, text));
      for (std::uint64_t more = 1 + random_() % 3; more > 0 && pulls < options_.upload_pulls;
           --more, ++pulls) {
        const qint64 place = static_cast<qint64>(random_() % static_cast<std::uint64_t>(text.size()));
        until("place in the upload", [&] { return upload.ended() || upload.sent_bytes() >= place; });
        if (upload.ended()) break;
        pull();
      }
      until("end of the upload", [&] { return upload.ended(); });
      if (upload.phase() != JobUpload::Phase::kStored)
        fail("the upload failed: " + upload.error().toStdString());
      if (read_back(name, text.size()) != text)
        fail("upload " + std::to_string(uploads) + " is not bit-identical");
    }
    std::printf("%d pulls during %d uploads: every upload bit-identical\n", pulls, uploads);
  }

  /// One job from the file to its end.
  void print() {
    const QString name = QStringLiteral("laps.gcode");
    const JobUpload& upload = *session_.upload(file(name, job()));
    until("end of the upload", [&] { return upload.ended(); });
    session_.home();
    until("machine that is homed", [this] { return session_.status().state() == joblink::STATE_READY; });
    ran_ = false;
    session_.start_job(name);
    until("job that runs", [this] { return ran_; });
    int pulls = 0;
    for (int i = 0; i < options_.print_pulls; ++i) {
      // Spread over the print; what remains of it after the last one is watched.
      const double place = (i + static_cast<double>(random_() % 1000) * 1e-3) / (options_.print_pulls + 1.0);
      until("progress", [&] { return !runs() || session_.status().progress() >= place; });
      if (!runs()) break;
      pull();
      ++pulls;
    }
    const int before = statuses_;
    until("end of the job", [this] { return session_.connected() && !runs(); });
    joblink::Reply reply;
    joblink::ClientMessage history;
    history.mutable_get_history()->set_max_runs(1);
    until("history", [&, asked = false]() mutable {
      if (!asked) session_.send(std::move(history), [&](const joblink::Reply& r) { reply = r; });
      asked = true;
      return reply.has_history() || reply.has_error();
    });
    if (reply.history().runs_size() != 1 || reply.history().runs(0).result() != joblink::JOB_COMPLETE)
      fail("the print did not end complete: " + reply.ShortDebugString());
    std::printf("%d pulls during the print: complete in %.1f s, watched to its end by %d statuses\n", pulls,
                reply.history().runs(0).duration_s(), statuses_ - before);
    if (pulls < options_.print_pulls) fail("the job was too short for all pulls");
    if (statuses_ == before) fail("nothing was seen of the end of the print");
  }

 private:
  static constexpr int kPatience_ms = 60'000;

  [[noreturn]] void fail(const std::string& words) const {
    throw std::runtime_error(words + "; last refusal: " + trouble_.toStdString() + " (seed " +
                             std::to_string(options_.seed) + ")");
  }
  void until(const char* what, const std::function<bool()>& holds) {
    const QDeadlineTimer deadline(kPatience_ms);
    while (!holds()) {
      if (deadline.hasExpired())
        fail(std::string("no ") + what + " in time; state " + session_.status().state_words() +
             ", link: " + session_.link_words().toStdString());
      QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents, 20);
    }
  }
  const FoundGateway* usb() const {
    for (const FoundGateway& gateway : finder_.gateways())
      if (gateway.way == FoundGateway::Way::kUsb) return &gateway;
    return nullptr;
  }
  bool runs() const {
    const auto state = session_.status().state();
    return state == joblink::STATE_RUNNING || state == joblink::STATE_CHECKING;
  }
  void write_udc(const std::string& text) const {
    std::ofstream out(options_.udc_file);
    out << text << "\n";
    out.flush();
  }
  void pull() {
    write_udc("");
    until("news of the pull", [this] { return !session_.connected(); });
    const QDeadlineTimer pause(static_cast<qint64>(random_() % 60));
    until("moment to plug in", [&] { return pause.hasExpired(); });
    write_udc(options_.udc);
    until("reconnection", [this] { return session_.connected(); });
  }
  QString file(const QString& name, const QByteArray& text) {
    QFile out(folder_.filePath(name));
    if (!out.open(QIODevice::WriteOnly) || out.write(text) != text.size()) fail("cannot write a file");
    return out.fileName();
  }
  QByteArray some_text(int size) {
    QByteArray text(size, '\n');
    for (int i = 0; i < size; ++i)
      if (i % 64 != 63) text[i] = static_cast<char>('0' + random_() % 75);
    return text;
  }
  QByteArray job() const {
    QByteArray text = "G21 G90\nG1 X-15 Y-15 Z0.3 F9000\n";
    for (int lap = 0; lap < options_.laps; ++lap)
      text += "G1 X15 Y-15 F6000\nG1 X15 Y15\nG3 X-15 Y15 I-15 J0\nG1 X-15 Y-15\n";
    return text + "G1 X10 Y-10 Z5\n";
  }
  QByteArray read_back(const QString& name, qsizetype size) {
    QByteArray text;
    while (text.size() < size) {
      joblink::ClientMessage request;
      request.mutable_read_job()->set_name(name.toStdString());
      request.mutable_read_job()->set_offset_bytes(static_cast<std::uint64_t>(text.size()));
      request.mutable_read_job()->set_max_bytes(1U << 18U);
      joblink::Reply reply;
      bool answered = false;
      session_.send(std::move(request), [&](const joblink::Reply& r) {
        reply = r;
        answered = true;
      });
      until("answer", [&] { return answered; });
      if (reply.job_text().data().empty()) fail("cannot read " + name.toStdString() + " back");
      text += QByteArray::fromStdString(reply.job_text().data());
    }
    return text;
  }

  Options options_;
  std::mt19937_64 random_;
  QTemporaryDir folder_;
  GatewayFinder finder_;
  Session session_;
  QString trouble_;
  int statuses_ = 0;
  bool ran_ = false;
};

int run(int argc, char** argv) {
  Options options;
  CLI::App cli("The desktop program's link and session on a real USB device");
  cli.add_option("--udc-file", options.udc_file)->required();
  cli.add_option("--udc", options.udc)->required();
  cli.add_option("--seed", options.seed);
  cli.add_option("--upload-pulls", options.upload_pulls);
  cli.add_option("--print-pulls", options.print_pulls);
  cli.add_option("--laps", options.laps, "Of about 1.5 s each; 0: nothing is printed");
  CLI11_PARSE(cli, argc, argv);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  QCoreApplication app(argc, argv);
  Desktop desktop(options);
  desktop.connect();
  desktop.uploads();
  if (options.laps > 0) desktop.print();
  return 0;
}

}  // namespace
}  // namespace kinebus::gui

int main(int argc, char** argv) try {
  return kinebus::gui::run(argc, argv);
} catch (const std::exception& error) {
  std::fprintf(stderr, "FAILED: %s\n", error.what());
  return 1;
}
