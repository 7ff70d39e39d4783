#include "gui/session/session.hpp"

#include <gtest/gtest.h>

#include <QApplication>
#include <QByteArray>
#include <QChar>
#include <QCoreApplication>
#include <QDateTime>
#include <QFile>
#include <QIODevice>
#include <QLocale>
#include <QTemporaryDir>
#include <QTranslator>

#include "gui/link/socket_link.hpp"
#include "gui/models/alarm_words.hpp"
#include "gui/models/axes_model.hpp"
#include "gui/models/events_model.hpp"
#include "gui/models/jobs_model.hpp"
#include "gui/models/nodes_model.hpp"
#include "gui/models/path_source.hpp"
#include "gui/session/gateway_words.hpp"
#include "gui/session/job_upload.hpp"
#include "gui/tests/fake_gateway.hpp"
#include "gui/tests/wait.hpp"
#include "protocol/canopen/alarm_table.hpp"

namespace kinebus::gui {
namespace {

class SessionTest : public testing::Test {
 protected:
  void connect() {
    session.connect_to([path = gateway.socket_path()] { return std::make_unique<SocketLink>(path); },
                       QStringLiteral("fake"));
    ASSERT_TRUE(wait_until([&] {
      return session.connected() && session.machine().joints_size() == 6 && session.status().time_s() > 0;
    }));
  }
  QString file(const QByteArray& text, const QString& name = QStringLiteral("part.gcode")) {
    QFile f(folder.filePath(name));
    EXPECT_TRUE(f.open(QIODevice::WriteOnly));
    f.write(text);
    return f.fileName();
  }
  QTemporaryDir folder;
  FakeGateway gateway;
  Session session;
};

TEST_F(SessionTest, ConnectingBringsMachineJobsAndStatus) {
  gateway.jobs["a.gcode"] = "G1 X1\n";
  connect();
  ASSERT_TRUE(wait_until([&] { return session.jobs().jobs_size() == 1; }));
  EXPECT_EQ(session.machine().name(), "M1");
  EXPECT_EQ(session.status().state(), joblink::STATE_READY);
}

TEST_F(SessionTest, CommandsTakeControlWhenNobodyHasIt) {
  connect();
  session.home();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kHome) == 1; }));
  EXPECT_EQ(gateway.count(joblink::ClientMessage::kTakeControl), 1);
  ASSERT_TRUE(wait_until([&] { return session.has_control(); }));
  session.go_to_reference();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kReference) == 1; }));
  EXPECT_EQ(gateway.count(joblink::ClientMessage::kTakeControl), 1);
}

TEST_F(SessionTest, HomingASleepingMachineWakesItFirst) {
  gateway.status.set_state(joblink::STATE_OFF);
  connect();
  session.home();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kBringUp) == 1; }));
  EXPECT_EQ(gateway.count(joblink::ClientMessage::kHome), 0);
  gateway.status.set_state(joblink::STATE_UNHOMED);
  EXPECT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kHome) == 1; }));
}

TEST_F(SessionTest, StopNeedsNoControl) {
  gateway.status.set_controller(3);  // another client
  connect();
  session.stop();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kStop) == 1; }));
  EXPECT_EQ(gateway.count(joblink::ClientMessage::kTakeControl), 0);
  EXPECT_TRUE(session.others_have_control());
}

TEST_F(SessionTest, RefusalsAreToldInWords) {
  connect();
  QString told;
  QObject::connect(&session, &Session::refused, &session, [&](const QString& words) { told = words; });
  gateway.refuse = QStringLiteral("not while a job runs");
  session.home();
  ASSERT_TRUE(wait_until([&] { return !told.isEmpty(); }));
  EXPECT_EQ(told, QStringLiteral("not while a job runs"));
}

TEST_F(SessionTest, BrokenLinkComesBackByItself) {
  connect();
  gateway.break_link();
  ASSERT_TRUE(wait_until([&] { return session.link_state() == Session::LinkState::kLost; }));
  ASSERT_TRUE(wait_until([&] { return session.connected(); }));
  EXPECT_GE(gateway.connections, 2);
}

TEST_F(SessionTest, UploadArrivesWholeThroughABrokenLink) {
  connect();
  QByteArray text;
  for (int i = 0; i < 200'000; ++i) text += "G1 X" + QByteArray::number(i % 997) + " E1\n";
  gateway.break_at_bytes = static_cast<std::size_t>(text.size() / 10);
  JobUpload* upload = session.upload(file(text));
  ASSERT_TRUE(wait_until([&] { return upload->phase() == JobUpload::Phase::kStored; }));
  EXPECT_TRUE(gateway.jobs["part.gcode"] == text.toStdString());
  EXPECT_GE(gateway.connections, 2);
}

TEST_F(SessionTest, UploadOfAMissingFileFailsInWords) {
  connect();
  JobUpload* upload = session.upload(folder.filePath(QStringLiteral("absent.gcode")));
  ASSERT_TRUE(wait_until([&] { return upload->ended(); }));
  EXPECT_EQ(upload->phase(), JobUpload::Phase::kFailed);
  EXPECT_FALSE(upload->error().isEmpty());
}

TEST_F(SessionTest, JobsModelShowsUploadsAboveJobs) {
  gateway.jobs["old.gcode"] = "G1 X1\n";
  JobsModel model(session);
  connect();
  ASSERT_TRUE(wait_until([&] { return model.rowCount() == 1; }));
  JobUpload* upload = session.upload(file("G1 X5 E1\n", QStringLiteral("new.gcode")));
  EXPECT_EQ(model.rowCount(), 2);
  EXPECT_EQ(model.upload_at(0), upload);
  ASSERT_TRUE(wait_until(
      [&] { return model.find(QStringLiteral("new.gcode")) != nullptr && model.upload_at(0) == nullptr; }));
  EXPECT_EQ(model.rowCount(), 2);
}

TEST_F(SessionTest, RunningJobsPathIsReadFromTheGatewayAndShown) {
  gateway.jobs["print.gcode"] = "G0 X0 Y0 Z0.2\nG1 X10 E1\nG1 Y10 E2\n; seed " +
                                std::to_string(QDateTime::currentMSecsSinceEpoch()) + "\n";
  PathSource path(session);
  connect();
  ASSERT_TRUE(wait_until([&] { return session.jobs().jobs_size() == 1; }));
  gateway.status.set_job("print.gcode");
  ASSERT_TRUE(wait_until([&] { return path.scene() != nullptr; }));
  EXPECT_EQ(path.name(), QStringLiteral("print.gcode"));
  EXPECT_EQ(path.scene()->path.line_count, 4u);
}

TEST_F(SessionTest, APathIsReadWithTheMachinesReferenceAndWorkZeros) {
  gateway.machine.mutable_bed_reference()->set_z_mm(120);
  gateway.status.set_work_system(2);
  gateway.status.mutable_work_offset()->set_y_mm(-4);
  PathSource path(session);
  connect();
  path.show_file(file("G28\nG1 X1 E1 ; here G54 is not known yet\nG55\nG1 Y0 E2\nG1 W5\n"));
  const auto last = [&] { return path.scene()->path.points_mm.back(); };
  ASSERT_TRUE(wait_until([&] { return path.scene() != nullptr; }));
  EXPECT_EQ(last(), (std::array<float, 3>{1, -4, 120}));
  EXPECT_EQ(path.scene()->path.refused_lines, 1u);
  // A zero that is set anew has the path read again.
  gateway.status.set_work_system(1);
  gateway.status.mutable_work_offset()->set_y_mm(0);
  gateway.status.mutable_work_offset()->set_x_mm(7);
  ASSERT_TRUE(wait_until([&] { return last()[0] == 8; }));
  EXPECT_EQ(last(), (std::array<float, 3>{8, -4, 120}));
  // Not under a job that runs: it keeps the zeros that it began with.
  gateway.status.set_job("another.gcode");
  gateway.status.mutable_work_offset()->set_x_mm(9);
  const double now = session.status().time_s();
  ASSERT_TRUE(wait_until([&] { return session.status().time_s() > now + 1; }));
  EXPECT_FALSE(path.loading());
  EXPECT_EQ(last()[0], 8);
}

TEST_F(SessionTest, AlarmsAreShownNewestFirstWithAdvice) {
  EventsModel events(session);
  connect();
  joblink::Event event;
  event.set_id(1);
  event.set_kind(joblink::EVENT_ALARM);
  event.set_code(0xFF85);
  event.set_node(2);
  event.set_words("node 2 has not been heard for 1.5 s");
  gateway.status.set_state(joblink::STATE_ALARM);
  gateway.say(event);
  ASSERT_TRUE(wait_until([&] { return events.open_alarms() == 1; }));
  EXPECT_FALSE(events.index(0).data(EventsModel::kAdvice).toString().isEmpty());
  EXPECT_TRUE(events.index(0).data(EventsModel::kDetails).toString().contains(QStringLiteral("1.5 s")));
  gateway.status.set_state(joblink::STATE_READY);
  ASSERT_TRUE(wait_until([&] { return events.open_alarms() == 0; }));
}

TEST_F(SessionTest, EveryAlarmHasHeadlineWordsAndAdviceInEveryLanguage) {
  for (const char* language : {"tr", "fa"}) {
    QTranslator translator;
    ASSERT_TRUE(translator.load(QStringLiteral(":/i18n/kinebus_%1.qm").arg(QLatin1String(language))));
    const auto said = [&](const char* words) { return translator.translate("Gateway", words); };
    const auto expect_said = [&](const AlarmRow& row) {
      ASSERT_TRUE(row.name && row.advice) << std::hex << row.code;
      EXPECT_FALSE(said(row.name).isEmpty()) << language << ": " << row.name;
      EXPECT_FALSE(said(row.advice).isEmpty()) << language << ": " << row.advice;
      // The gateway's own alarms (FF80h and above) say what has happened with its place.
      ASSERT_TRUE(row.words != nullptr || row.code >= 0xFF80) << std::hex << row.code;
      if (row.words == nullptr) return;
      EXPECT_FALSE(said(row.words).isEmpty()) << language << ": " << row.words;
    };
    for (const AlarmRow& row : kAlarms) expect_said(row);
    for (const AlarmRow& row : kAlarmClasses) expect_said(row);
    expect_said(kUnknownAlarm);
  }
  EXPECT_EQ(AlarmWords::title(0x3130), QStringLiteral("A motor phase is open"));
  EXPECT_EQ(AlarmWords::title(0x4310), QStringLiteral("A drive is too hot"));
  EXPECT_EQ(AlarmWords::title(0x3299), QStringLiteral("The supply voltage is wrong"));
  EXPECT_EQ(AlarmWords::sentence(AlarmWords::advice(0xFF84)),
            QStringLiteral("Switch one of the gateways off."));
}

TEST_F(SessionTest, WhatTheGatewaySaysIsToldInTheUsersLanguage) {
  QTranslator turkish;
  ASSERT_TRUE(turkish.load(QStringLiteral(":/i18n/kinebus_tr.qm")));
  const auto verbatim = [](joblink::Sentence& part, const char* text) {
    part.set_text(text);
    part.set_verbatim(true);
  };
  joblink::Problem problem;
  problem.set_place("line 4");
  problem.set_rule("the job does not go on: X is 0.720 mm outside the workspace");
  problem.mutable_rule_said()->set_text("the job does not go on: %1");
  joblink::Sentence& why = *problem.mutable_rule_said()->add_parts();
  why.set_text("%1 is %2 outside the workspace");
  verbatim(*why.add_parts(), "X");
  verbatim(*why.add_parts(), "%1 mm");
  const auto told = [&] { return GatewayWords::said(problem).remove(QChar(0x2066)).remove(QChar(0x2069)); };
  EXPECT_EQ(told(), QStringLiteral("line 4: the job does not go on: X is %1 mm outside the workspace"));
  QCoreApplication::installTranslator(&turkish);
  EXPECT_EQ(told(), QStringLiteral("line 4: iş sürmüyor: X çalışma alanının %1 mm dışında"));
  const QLocale before;
  QLocale::setDefault(QLocale(QStringLiteral("tr")));
  verbatim(*why.mutable_parts(1), "0.720 mm");
  EXPECT_EQ(told(), QStringLiteral("line 4: iş sürmüyor: X çalışma alanının 0,720 mm dışında"));
  verbatim(*why.mutable_parts(0), "G38.2");
  verbatim(*why.mutable_parts(1), "10.0.0.1");
  EXPECT_EQ(told(), QStringLiteral("line 4: iş sürmüyor: G38.2 çalışma alanının 10.0.0.1 dışında"))
      << "names are nobody's numbers";
  why.set_text("G%1 is not for M%2");
  verbatim(*why.mutable_parts(0), "38.2");
  EXPECT_EQ(told(), QStringLiteral("line 4: iş sürmüyor: G38.2 is not for M10.0.0.1"));
  QLocale::setDefault(before);
  verbatim(*why.mutable_parts(0), "X");
  verbatim(*why.mutable_parts(1), "%1 mm");
  why.set_text("%1 is %2 something that only a newer gateway says");
  EXPECT_EQ(told(),
            QStringLiteral("line 4: iş sürmüyor: X is %1 mm something that only a newer gateway says"));
  problem.clear_rule_said();
  EXPECT_EQ(told(), QStringLiteral("line 4: the job does not go on: X is 0.720 mm outside the workspace"))
      << "an older gateway says it in English alone";
  // A sentence within itself, over and over, from somebody who means no good.
  joblink::Sentence* deep = problem.mutable_rule_said();
  for (int i = 0; i < 60; ++i) {
    deep->set_text("the job does not go on: %1");
    deep = deep->add_parts();
  }
  EXPECT_LT(told().size(), 1000);
  QCoreApplication::removeTranslator(&turkish);
}

TEST_F(SessionTest, AnAxisWithAnEncoderSaysWhereItReallyIs) {
  AxesModel axes(session);
  const auto said = [&](int row, AxesModel::Column column) {
    return axes.index(row, column).data().toString().remove(QChar(0x2066)).remove(QChar(0x2069));
  };
  for (int i = 0; i < 6; ++i) gateway.status.add_joints(290);
  connect();
  ASSERT_TRUE(wait_until([&] { return session.status().joints_size() == 6; }));
  EXPECT_FALSE(axes.measured());
  EXPECT_EQ(said(0, AxesModel::kMeasured), QStringLiteral("–"));
  gateway.status.mutable_nodes(0)->mutable_axes(1)->set_off_course(0.012);
  ASSERT_TRUE(wait_until([&] { return axes.measured(); }));
  EXPECT_EQ(said(0, AxesModel::kMeasured), QStringLiteral("–")) << "the other axis of the node has none";
  EXPECT_EQ(said(1, AxesModel::kPosition), QStringLiteral("290.000 mm"));
  EXPECT_EQ(said(1, AxesModel::kMeasured), QStringLiteral("289.988 mm"));
  EXPECT_EQ(said(1, AxesModel::kError), QStringLiteral("-12 µm"));
}

TEST_F(SessionTest, AJointWithALinearScaleIsShownByItBesideWhereItWasTold) {
  AxesModel axes(session);
  const auto said = [&](int row, AxesModel::Column column) {
    return axes.index(row, column).data().toString().remove(QChar(0x2066)).remove(QChar(0x2069));
  };
  for (int i = 0; i < 6; ++i) gateway.status.add_joints(290);
  gateway.status.set_positions_known(true);
  connect();
  ASSERT_TRUE(wait_until([&] { return session.status().joints_size() == 6; }));
  EXPECT_FALSE(axes.scaled());
  session.disconnect_from_gateway();
  gateway.machine.mutable_joints(1)->set_has_scale(true);
  connect();
  ASSERT_TRUE(wait_until([&] { return axes.scaled(); }));
  EXPECT_EQ(said(1, AxesModel::kByScale), QStringLiteral("–")) << "nothing is read before it rests";
  gateway.status.mutable_nodes(0)->mutable_axes(1)->set_by_scale_mm(290.35);
  ASSERT_TRUE(wait_until([&] { return said(1, AxesModel::kByScale) == QStringLiteral("290.350 mm"); }));
  EXPECT_EQ(said(1, AxesModel::kPosition), QStringLiteral("290.000 mm"));
  EXPECT_EQ(said(1, AxesModel::kScaleError), QStringLiteral("350 µm")) << "it went too far";
  EXPECT_EQ(said(0, AxesModel::kByScale), QStringLiteral("–"));
  EXPECT_EQ(said(0, AxesModel::kScaleError), QStringLiteral("–"));
  gateway.status.mutable_nodes(0)->mutable_axes(1)->set_by_scale_mm(289.9999);
  ASSERT_TRUE(wait_until([&] { return said(1, AxesModel::kScaleError) == QStringLiteral("0 µm"); }));
  // It moves, and nothing is said of where it is now.
  gateway.status.mutable_nodes(0)->mutable_axes(1)->clear_by_scale_mm();
  ASSERT_TRUE(wait_until([&] { return said(1, AxesModel::kScaleError) == QStringLiteral("–"); }));
}

TEST_F(SessionTest, AxesAndNodesFollowTheStatus) {
  AxesModel axes(session);
  NodesModel nodes(session);
  for (int i = 0; i < 6; ++i) gateway.status.add_joints(i < 4 ? 290 : 0);
  gateway.status.mutable_nodes(1)->set_inputs(1);
  connect();
  ASSERT_TRUE(wait_until([&] { return nodes.rowCount() == 3; }));
  EXPECT_EQ(axes.rowCount(), 6);
  EXPECT_DOUBLE_EQ(axes.index(0, AxesModel::kTravel).data(AxesModel::kShare).toDouble(), 0.5);
  EXPECT_TRUE(axes.index(2, AxesModel::kSwitch).data(AxesModel::kSwitchOn).toBool());
  EXPECT_FALSE(axes.index(0, AxesModel::kSwitch).data(AxesModel::kSwitchOn).toBool());
}

}  // namespace
}  // namespace kinebus::gui

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  qputenv("QT_QPA_PLATFORM", "offscreen");
  QCoreApplication::setApplicationName(QStringLiteral("kinebus-gui-test"));
  QApplication app(argc, argv);
  return RUN_ALL_TESTS();
}
