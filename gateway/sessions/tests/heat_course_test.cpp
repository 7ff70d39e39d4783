// What heaters did, for a client that comes in the middle of a job: whole, in order, and bounded.

#include "gateway/sessions/heat_course.hpp"
#include "gateway/sessions/tests/link_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

MachineStatus heat_at(int second, const char* job = "", double elapsed_s = 0) {
  MachineStatus status;
  status.now = std::chrono::seconds{second};
  status.job = job;
  status.elapsed_s = elapsed_s;
  status.state = MachineState::kReady;
  for (const HeaterId id : {kFirstHotend, kFirstBed}) {
    NamedHeaterStatus heater;
    heater.id = id;
    heater.name = id == kFirstBed ? "bed" : "hotend";
    heater.actual_celsius = 20 + 0.1 * (second % 1000);
    heater.target_celsius = 210;
    if (id == kFirstBed) heater.power = 0.25;
    status.heaters.push_back(heater);
  }
  status.fans.push_back({"part", 0, 0.5});
  return status;
}

TEST(HeatCourse, KeepsTheWholeOfALongJobWithinItsBounds) {
  HeatCourse course;
  constexpr int kJob_s = 30 * 3600;
  for (int i = 0; i < 50; ++i) course.take(heat_at(i));
  EXPECT_EQ(course.message().job().time_s_size(), 0);
  for (int i = 0; i < kJob_s; ++i) course.take(heat_at(50 + i, "part", i));
  const joblink::HeatCourse told = course.message();
  EXPECT_EQ(std::vector<std::string>(told.heaters().begin(), told.heaters().end()),
            (std::vector<std::string>{"hotend", "bed"}));
  EXPECT_EQ(told.recent().time_s_size(), static_cast<int>(HeatCourse::kRecent));
  EXPECT_EQ(told.recent().time_s(HeatCourse::kRecent - 1), 49 + kJob_s);
  const joblink::HeatSamples& job = told.job();
  EXPECT_EQ(told.job_name(), "part");
  EXPECT_LE(job.time_s_size(), static_cast<int>(HeatCourse::kMostOfJob));
  EXPECT_GT(job.time_s_size(), static_cast<int>(HeatCourse::kMostOfJob / 4));
  EXPECT_EQ(job.time_s(0), 50) << "from its beginning on";
  EXPECT_GT(job.time_s(job.time_s_size() - 1), 49 + kJob_s - 2 * job.period_s());
  ASSERT_EQ(job.actual_decicelsius_size(), 2 * job.time_s_size());
  ASSERT_EQ(job.fan_permille_size(), job.time_s_size());
  for (int i = 0; i < job.time_s_size(); ++i) {
    const int second = static_cast<int>(job.time_s(i));
    EXPECT_EQ(job.actual_decicelsius(2 * i), 200 + second % 1000) << i;
    EXPECT_EQ(job.power_permille(2 * i), -1) << "not told";
    EXPECT_EQ(job.power_permille(2 * i + 1), 250);
    EXPECT_EQ(job.fan_permille(i), 500u);
    EXPECT_GT(job.time_s(i), i > 0 ? job.time_s(i - 1) : 0);
  }
  EXPECT_LT(told.ByteSizeLong(), joblink::kMaxMessageBytes / 4);

  // When it is over it stays, until the next one begins.
  for (int i = 0; i < 50; ++i) course.take(heat_at(50 + kJob_s + i));
  EXPECT_EQ(course.message().job_name(), "");
  EXPECT_GT(course.message().job().time_s_size(), 100);
  course.take(heat_at(200 + kJob_s, "part", 0));
  EXPECT_EQ(course.message().job().time_s_size(), 1);
}

TEST(HeatCourse, AJobThatBeginsAgainOrAnotherOneBeginsItsCourseAnew) {
  HeatCourse course;
  for (int i = 0; i < 1300; ++i) course.take(heat_at(i, "a", i));
  EXPECT_EQ(course.message().job().period_s(), 2) << "thinned by half";
  EXPECT_EQ(course.message().job_elapsed_s(), 1299);
  ASSERT_EQ(course.message().job().time_s_size(), 650);
  for (int i = 0; i < 650; ++i) EXPECT_DOUBLE_EQ(course.message().job().time_s(i), 2 * i);
  EXPECT_EQ(course.message().recent().period_s(), 1);
  course.take(heat_at(2000, "a", 1));
  EXPECT_EQ(course.message().job().time_s_size(), 1) << "the same name, from its beginning";
  EXPECT_EQ(course.message().job().period_s(), 1);
  course.take(heat_at(2001, "b", 2));
  EXPECT_EQ(course.message().job().time_s_size(), 1) << "another name";
  course.take(heat_at(2002, "b", 3));
  EXPECT_EQ(course.message().job().time_s_size(), 2);
}

TEST(HeatCourse, TheLastTenMinutesAreInOrderAndNothingElseIsAmongThem) {
  HeatCourse course;
  for (int i = 0; i < 1000; ++i) {
    course.take(heat_at(i));
    MachineStatus other = heat_at(i);
    if (i % 2 == 0)
      other.fans.clear();
    else
      other.heaters.pop_back();
    course.take(other);
  }
  const joblink::HeatSamples recent = course.message().recent();
  ASSERT_EQ(recent.time_s_size(), 600);
  for (int i = 0; i < 600; ++i) EXPECT_DOUBLE_EQ(recent.time_s(i), 400 + i);
  EXPECT_EQ(recent.actual_decicelsius_size(), 1200);
}

TEST(HeatCourse, BeginsWhenWhatItsHeatersMeasureIsKnown) {
  HeatCourse course;
  for (const MachineState state : {MachineState::kOff, MachineState::kBringUp, MachineState::kUnhomed,
                                   MachineState::kOff, MachineState::kReady}) {
    const int second = static_cast<int>(state) + 10 * course.message().recent().time_s_size();
    MachineStatus status = heat_at(second);
    status.state = state;
    course.take(status);
  }
  EXPECT_EQ(course.message().recent().time_s_size(), 3) << "and goes on when the drives are without power";
}

TEST(HeatCourse, AClientThatComesLateIsToldWhatWasBefore) {
  LinkRig rig;
  ASSERT_TRUE(rig.machine.make_ready()) << rig.machine.story();
  LinkedClient& anna = rig.connect("anna", 20);
  rig.upload(anna, "heats.gcode", "G21 G90\nM104 S100\nG4 P60000\nG1 X5 Z10 F600\nG4 P30000\n");
  rig.pump();
  joblink::ClientMessage start;
  start.mutable_start_job()->set_name("heats.gcode");
  ASSERT_FALSE(rig.ask(anna, start).has_error());
  rig.run_for(40s);
  LinkedClient& late = rig.connect("late", 20);
  const joblink::HeatCourse told =
      rig.ask(late, plain(&joblink::ClientMessage::mutable_get_heat_course)).heat_course();
  EXPECT_EQ(told.job_name(), "heats.gcode");
  ASSERT_GT(told.job().time_s_size(), 30);
  const int heaters = told.heaters_size();
  const auto found = std::find(told.heaters().begin(), told.heaters().end(), "hotend");
  ASSERT_NE(found, told.heaters().end());
  const auto first = static_cast<int>(found - told.heaters().begin());
  const int last = heaters * (told.job().time_s_size() - 1) + first;
  EXPECT_LT(told.job().actual_decicelsius(first), 300) << "as it was when the job began";
  EXPECT_GT(told.job().actual_decicelsius(last), 600);
  EXPECT_EQ(told.job().target_decicelsius(last), 1000);
}

}  // namespace
}  // namespace kinebus
