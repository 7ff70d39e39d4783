#pragma once
// The gateway's end of the job link as far as the desktop program sees it, on a real local socket: answers, a
// store of jobs in memory, and a machine whose status the test sets. For what a real gateway would not do on
// command: refusals, broken links, alarms.

#include <QLocalServer>
#include <QLocalSocket>
#include <QTemporaryDir>
#include <QTimer>
#include <initializer_list>
#include <map>
#include <memory>

#include "protocol/joblink/client.hpp"

namespace kinebus::gui {

class FakeGateway : public QObject {
  Q_OBJECT
 public:
  FakeGateway();
  QString socket_path() const { return folder_.filePath(QStringLiteral("gateway.sock")); }

  joblink::Status status;
  joblink::MachineInfo machine;
  std::map<std::string, std::string> jobs;  ///< name to text
  joblink::PreflightResult preflight;
  std::string machine_file = "name = \"M1\"\n";
  bool machine_file_newer = false;  ///< than what it runs with
  std::vector<joblink::ClientMessage> heard;
  QString refuse;  ///< the next command is refused so
  int connections = 0;
  /// The link breaks, once, when so much of an upload has come.
  std::size_t break_at_bytes = SIZE_MAX;

  /// The status says that these commands, and no others, may be given.
  void allow(std::initializer_list<joblink::Command> commands);
  int count(joblink::ClientMessage::RequestCase request) const;
  void say(const joblink::Event& event);
  void send_status();
  /// As a pulled cable: nothing more comes, nothing more is heard.
  void break_link();

 private:
  void take(const joblink::ClientMessage& message);
  void answer(const joblink::ClientMessage& message, joblink::Reply& reply);
  void write(const joblink::ServerMessage& message);

  QTemporaryDir folder_;
  QLocalServer server_;
  QLocalSocket* socket_ = nullptr;
  joblink::FrameReader reader_;
  std::uint32_t session_ = 0, sequence_ = 0;
  std::string upload_name_, upload_text_;
  std::uint64_t upload_size_ = 0;
  QTimer statuses_;
};

/// The machine M1 as the gateway describes it.
joblink::MachineInfo m1_info();

}  // namespace kinebus::gui
