#include "gui/tests/fake_gateway.hpp"

#include <QByteArray>

#include <algorithm>

#include "protocol/joblink/job_hash.hpp"

namespace kinebus::gui {

joblink::MachineInfo m1_info() {
  joblink::MachineInfo m;
  m.set_name("M1");
  m.set_kinematics("m1");
  m.set_bus("inproc");
  const double feet[4][2] = {{273, 63}, {273, -63}, {-273, -252}, {-273, 252}};
  const double attachments[4][2] = {{124, 128}, {124, -128}, {-124, -69}, {-124, 69}};
  for (int i = 0; i < 6; ++i) {
    auto& joint = *m.add_joints();
    joint.set_name(i < 4 ? "tower" + std::to_string(i + 1) : i == 4 ? "C" : "E");
    joint.set_rotary(i == 4);
    joint.set_node(static_cast<std::uint32_t>(i / 2 + 1));
    joint.set_axis(static_cast<std::uint32_t>(i % 2));
    joint.set_speed_per_s(450);
    if (i >= 4) continue;
    joint.set_home_switch(static_cast<std::uint32_t>(i % 2 + 1));
    joint.mutable_travel()->set_min(40);
    joint.mutable_travel()->set_max(540);
    auto& leg = *m.mutable_legs()->add_legs();
    leg.mutable_foot()->set_x_mm(feet[i][0]);
    leg.mutable_foot()->set_y_mm(feet[i][1]);
    leg.mutable_rail()->set_z_mm(1);
    leg.mutable_attachment()->set_x_mm(attachments[i][0]);
    leg.mutable_attachment()->set_y_mm(attachments[i][1]);
    leg.mutable_attachment()->set_z_mm(-5);
    leg.set_length_mm(991);
    leg.set_connector_mm(i < 2 ? 0 : 15);
    leg.set_carriage_above(false);
    leg.mutable_travel_mm()->set_min(40);
    leg.mutable_travel_mm()->set_max(540);
  }
  m.mutable_legs()->mutable_nozzle()->set_z_mm(1340);
  for (std::uint32_t i = 1; i <= 3; ++i) m.add_nodes()->set_id(i);
  m.mutable_reach()->set_radius_mm(150);
  m.mutable_reach()->mutable_z_mm()->set_min(-5);
  m.mutable_reach()->mutable_z_mm()->set_max(250);
  m.set_hotend_max_celsius(300);
  m.set_bed_max_celsius(120);
  const auto heater = [&](const char* name, joblink::HeaterKind kind, double max_celsius,
                          double usual_celsius) {
    auto& added = *m.add_heaters();
    added.set_name(name);
    added.set_kind(kind);
    added.set_max_celsius(max_celsius);
    added.set_usual_celsius(usual_celsius);
  };
  heater("hotend", joblink::HEATER_HOTEND, 300, 200);
  heater("bed", joblink::HEATER_BED, 120, 80);
  return m;
}

FakeGateway::FakeGateway() : machine(m1_info()), server_(this), statuses_(this) {
  using namespace joblink;
  status.set_state(STATE_READY);
  allow({COMMAND_START_JOB, COMMAND_STOP, COMMAND_HOME, COMMAND_REFERENCE, COMMAND_JOG, COMMAND_SET_OVERRIDE,
         COMMAND_SET_TEMPERATURE, COMMAND_SET_FAN, COMMAND_MOTORS_OFF, COMMAND_SET_WORK_OFFSET,
         COMMAND_SET_MOTOR_CURRENTS, COMMAND_TUNE_MOTOR, COMMAND_JOG_MOTOR, COMMAND_TUNE_HEATER,
         COMMAND_MOVE_PROBE_PIN});
  status.set_positions_known(true);
  status.mutable_tool()->set_z_mm(20);
  status.set_feed_override(1);
  for (const auto& info : machine.heaters()) {
    auto& heater = *status.add_heaters();
    heater.set_name(info.name());
    heater.set_kind(info.kind());
    heater.set_actual_celsius(24);
  }
  for (std::uint32_t i = 1; i <= 3; ++i) {
    auto& node = *status.add_nodes();
    node.set_id(i);
    node.set_present(true);
    node.set_nmt_state(5);
    node.set_synchronised(true);
    node.set_queue_capacity(128);
    for (int axis = 0; axis < 2; ++axis) node.add_axes()->set_enabled(true);
  }
  connect(&server_, &QLocalServer::newConnection, this, [this] {
    socket_ = server_.nextPendingConnection();
    ++connections;
    reader_.clear();
    connect(socket_, &QLocalSocket::readyRead, this, [this, socket = socket_] {
      const QByteArray bytes = socket->readAll();
      reader_.add(
          {reinterpret_cast<const std::uint8_t*>(bytes.constData()), static_cast<std::size_t>(bytes.size())});
      while (const auto frame = reader_.next()) {
        if (frame->sequence == 0) {
          session_ = frame->session;
          sequence_ = 0;
        }
        joblink::ClientMessage message;
        if (message.ParseFromArray(frame->message.data(), static_cast<int>(frame->message.size())))
          take(message);
      }
    });
  });
  connect(&statuses_, &QTimer::timeout, this, &FakeGateway::send_status);
  server_.listen(socket_path());
}

void FakeGateway::allow(std::initializer_list<joblink::Command> commands) {
  status.clear_commands();
  const auto& all = *joblink::Command_descriptor();
  for (int i = 1; i < all.value_count(); ++i) {
    auto& command = *status.add_commands();
    command.set_command(static_cast<joblink::Command>(all.value(i)->number()));
    command.set_allowed(std::find(commands.begin(), commands.end(), command.command()) != commands.end());
    if (!command.allowed()) command.mutable_why_not()->set_text("home it first");
  }
}

int FakeGateway::count(joblink::ClientMessage::RequestCase request) const {
  return static_cast<int>(
      std::count_if(heard.begin(), heard.end(), [&](const auto& m) { return m.request_case() == request; }));
}

void FakeGateway::break_link() {
  statuses_.stop();
  if (socket_ == nullptr) return;
  socket_->disconnect(this);
  socket_->abort();
  socket_->deleteLater();
  socket_ = nullptr;
}

void FakeGateway::write(const joblink::ServerMessage& message) {
  if (socket_ == nullptr) return;
  std::string bytes;
  joblink::append_frame(bytes, session_, sequence_, message.SerializeAsString());
  sequence_ = joblink::SessionSequence::after(sequence_);
  socket_->write(bytes.data(), static_cast<qint64>(bytes.size()));
  socket_->flush();
}

void FakeGateway::send_status() {
  status.set_time_s(status.time_s() + 0.04);
  joblink::ServerMessage message;
  *message.mutable_status() = status;
  write(message);
}

void FakeGateway::say(const joblink::Event& event) {
  joblink::ServerMessage message;
  *message.mutable_event() = event;
  write(message);
}

void FakeGateway::take(const joblink::ClientMessage& message) {
  heard.push_back(message);
  joblink::ServerMessage out;
  auto& reply = *out.mutable_reply();
  reply.set_request_id(message.request_id());
  const bool session_matter =
      message.has_hello() || message.has_watch() || message.has_take_control() || message.has_ping();
  if (!refuse.isEmpty() && !session_matter) {
    reply.mutable_error()->set_rule(refuse.toStdString());
    refuse.clear();
  } else {
    answer(message, reply);
  }
  write(out);
}

void FakeGateway::answer(const joblink::ClientMessage& message, joblink::Reply& reply) {
  using M = joblink::ClientMessage;
  switch (message.request_case()) {
    case M::kHello: {
      auto& hello = *reply.mutable_hello();
      hello.set_version_major(joblink::kVersionMajor);
      hello.set_client_id(7);
      hello.set_max_chunk_bytes(64 * 1024);
      hello.set_upload_window_bytes(1024 * 1024);
      break;
    }
    case M::kWatch:
      statuses_.start(20);
      break;
    case M::kTakeControl:
      status.set_controller(7);
      break;
    case M::kGetMachine:
      *reply.mutable_machine() = machine;
      break;
    case M::kListJobs:
      for (const auto& [name, text] : jobs) {
        auto& job = *reply.mutable_jobs()->add_jobs();
        job.set_name(name);
        job.set_size_bytes(text.size());
        job.set_hash(joblink::job_hash_of(text));
      }
      reply.mutable_jobs();
      break;
    case M::kDeleteJob:
      jobs.erase(message.delete_job().name());
      break;
    case M::kReadJob: {
      const std::string& text = jobs[message.read_job().name()];
      auto& page = *reply.mutable_job_text();
      page.set_size_bytes(text.size());
      page.set_offset_bytes(message.read_job().offset_bytes());
      page.set_data(text.substr(std::min<std::size_t>(text.size(), message.read_job().offset_bytes()),
                                message.read_job().max_bytes()));
      break;
    }
    case M::kCheckJob:
      *reply.mutable_preflight() = preflight;
      reply.mutable_preflight()->set_name(message.check_job().name());
      break;
    case M::kUploadBegin:
      if (upload_name_ != message.upload_begin().name()) upload_text_.clear();
      upload_name_ = message.upload_begin().name();
      upload_size_ = message.upload_begin().size_bytes();
      reply.mutable_upload()->set_upload_id(1);
      reply.mutable_upload()->set_received_bytes(upload_text_.size());
      break;
    case M::kUploadChunk:
      if (message.upload_chunk().offset_bytes() == upload_text_.size())
        upload_text_ += message.upload_chunk().data();
      if (upload_text_.size() >= break_at_bytes) {
        break_at_bytes = SIZE_MAX;
        return break_link();
      }
      reply.mutable_upload()->set_upload_id(1);
      reply.mutable_upload()->set_received_bytes(upload_text_.size());
      break;
    case M::kUploadCommit:
      jobs[upload_name_] = upload_text_;
      reply.mutable_upload()->set_stored(true);
      reply.mutable_upload()->set_received_bytes(upload_text_.size());
      upload_text_.clear();
      break;
    case M::kConsole:
      reply.mutable_console()->set_text("echo " + message.console().line());
      break;
    case M::kReadMachineFile:
      reply.mutable_machine_file()->set_text(machine_file);
      reply.mutable_machine_file()->set_writable(true);
      reply.mutable_machine_file()->set_restart_needed(machine_file_newer);
      break;
    case M::kCheckMachineFile: {
      auto& check = *reply.mutable_machine_file_check();
      if (message.check_machine_file().text().find("wrong") != std::string::npos) {
        auto& problem = *check.add_problems();
        problem.set_place("joint.tower1.speed_mm_per_s");
        problem.set_rule("found -3");
        problem.set_line(2);
      }
      break;
    }
    case M::kWriteMachineFile:
      machine_file = message.write_machine_file().text();
      reply.mutable_machine_file()->set_text(machine_file);
      reply.mutable_machine_file()->set_writable(true);
      break;
    default:
      break;
  }
}

}  // namespace kinebus::gui
