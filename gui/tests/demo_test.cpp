// Against the real daemon with its simulated machine: connect, home, upload, check, print to the end.
#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QFile>
#include <QIODevice>
#include <QTemporaryDir>

#include "gui/link/demo_gateway.hpp"
#include "gui/link/socket_link.hpp"
#include "gui/session/job_upload.hpp"
#include "gui/session/session.hpp"
#include "gui/tests/wait.hpp"

namespace kinebus::gui {
namespace {

constexpr int kPatience_ms = 150'000;

TEST(DemoMachine, UploadsHomesAndPrintsAJobToItsEnd) {
  DemoGateway demo;
  Session session;
  QString trouble;
  QObject::connect(&demo, &DemoGateway::failed, &session, [&](const QString& why) { trouble = why; });
  QObject::connect(&session, &Session::refused, &session, [&](const QString& why) { trouble = why; });
  QObject::connect(&demo, &DemoGateway::ready, &session, [&] {
    session.connect_to([path = demo.socket_path()] { return std::make_unique<SocketLink>(path); },
                       QStringLiteral("demo"));
  });
  demo.start();
  ASSERT_TRUE(
      wait_until([&] { return session.connected() && session.machine().joints_size() > 0; }, kPatience_ms))
      << trouble.toStdString();
  EXPECT_EQ(session.machine().kinematics(), "m1");

  QTemporaryDir folder;
  QFile file(folder.filePath(QStringLiteral("square.ngc")));
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("G21 G90\nG1 X20 Y0 Z10 F6000\nG1 X20 Y20\nG1 X-20 Y20\nG1 X-20 Y-20\nG1 X20 Y-20\n");
  file.close();
  JobUpload* upload = session.upload(file.fileName());
  ASSERT_TRUE(wait_until([&] { return upload->ended(); }, kPatience_ms));
  ASSERT_EQ(upload->phase(), JobUpload::Phase::kStored) << upload->error().toStdString();
  joblink::Reply checked;
  session.check_job(QStringLiteral("square.ngc"), [&](const joblink::Reply& reply) { checked = reply; });
  ASSERT_TRUE(wait_until([&] { return checked.has_preflight() || checked.has_error(); }, kPatience_ms));
  EXPECT_EQ(checked.preflight().summary().errors(), 0u) << checked.ShortDebugString();

  session.home();
  ASSERT_TRUE(wait_until([&] { return session.status().state() == joblink::STATE_READY; }, kPatience_ms))
      << trouble.toStdString();
  EXPECT_TRUE(session.has_control());
  session.start_job(QStringLiteral("square.ngc"));
  bool ran = false;
  ASSERT_TRUE(wait_until(
      [&] {
        ran = ran || session.status().state() == joblink::STATE_RUNNING;
        return ran && session.status().state() == joblink::STATE_READY;
      },
      kPatience_ms))
      << trouble.toStdString();
  EXPECT_NEAR(session.status().tool().x_mm(), 20, 1e-2);
  EXPECT_NEAR(session.status().tool().y_mm(), -20, 1e-2);
}

}  // namespace
}  // namespace kinebus::gui

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QCoreApplication app(argc, argv);
  return RUN_ALL_TESTS();
}
