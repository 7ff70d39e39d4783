#include "gateway/gcode/codes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "gateway/gcode/o_word.hpp"
#include "gateway/gcode/parameters.hpp"

namespace kinebus::gcode {
namespace {

constexpr CodeEntry g(int tenths, GGroup group, std::string_view words, std::string_view meaning) {
  return {tenths, static_cast<std::uint8_t>(group), group == GGroup::kHarmless, words, meaning};
}
constexpr CodeEntry m(int number, MGroup group, bool text, std::string_view words, std::string_view meaning) {
  return {number, static_cast<std::uint8_t>(group), text, words, meaning};
}
using G = GGroup;
using M = MGroup;

// clang-format off
constexpr std::array kG = {
    g(0, G::kMotion, "X Y Z A C E F", "traverse, at most as fast as gcode.traverse_mm_per_s of the machine file; with E a feed move"),
    g(10, G::kMotion, "X Y Z A C E F", "feed move in a straight line"),
    g(20, G::kMotion, "X Y Z A C E F I J K | R P", "arc or helix clockwise in the plane of G17, G18, G19; P turns"),
    g(30, G::kMotion, "X Y Z A C E F I J K | R P", "arc or helix counterclockwise"),
    g(40, G::kNonmodal, "P | S", "dwell: S in seconds, P in the machine file's gcode.dwell_p_unit; without a word come to rest"),
    g(50, G::kMotion, "X Y Z E F I J P Q", "cubic spline in G17: I J from the start and P Q from the end to its control points; without I J it goes on smoothly. Flattened within 2 um"),
    g(51, G::kMotion, "X Y Z E F I J", "quadratic spline in G17: I J from the start to its control point. Flattened within 2 um"),
    g(80, G::kHarmless, "", "lathe radius mode: as always"),
    g(100, G::kNonmodal, "L P X Y Z A C", "L2, L20: coordinate system offsets (P0: the active one); P S: temperature S of tool P; without L: retract as set by M207"),
    g(110, G::kNonmodal, "", "recover what G10 retracted, as set by M208"),
    g(120, G::kHarmless, "", "nozzle wipe"),
    g(170, G::kPlane, "", "plane XY"),
    g(180, G::kPlane, "", "plane ZX"),
    g(190, G::kPlane, "", "plane YZ"),
    g(200, G::kUnits, "", "lengths in inches"),
    g(210, G::kUnits, "", "lengths in millimetres"),
    g(260, G::kHarmless, "", "test pattern"),
    g(270, G::kHarmless, "", "park"),
    g(280, G::kNonmodal, "X Y Z A C", "home the named axes, or all"),
    g(290, G::kHarmless, "", "bed levelling"),
    g(300, G::kNonmodal, "", "single probe of printers: without effect here; refused on machines with a spindle"),
    g(320, G::kHarmless, "", "bed levelling"),
    g(330, G::kHarmless, "", "calibration"),
    g(340, G::kHarmless, "", "levelling of Z motors"),
    g(400, G::kCutter, "", "cutter compensation off"),
    g(430, G::kToolLength, "H", "tool length H of gcode.tool_length_mm, without H that of T"),
    g(431, G::kToolLength, "Z", "tool length Z"),
    g(434, G::kToolLength, "H", "tool centre point control"),
    g(490, G::kToolLength, "", "tool length and tool centre point control off"),
    g(520, G::kNonmodal, "X Y Z A C", "local offset of the work coordinates; shares its values with G92"),
    g(530, G::kNonmodal, "", "with G0 or G1: the line's coordinates are the machine's"),
    g(531, G::kNonmodal, "P", "in a tilted plane: turn A and C until the tool is normal to it; P1, P2: A positive, negative"),
    g(540, G::kCoordinates, "", "work coordinates 1"),
    g(550, G::kCoordinates, "", "work coordinates 2"),
    g(560, G::kCoordinates, "", "work coordinates 3"),
    g(570, G::kCoordinates, "", "work coordinates 4"),
    g(580, G::kCoordinates, "", "work coordinates 5"),
    g(590, G::kCoordinates, "", "work coordinates 6"),
    g(591, G::kCoordinates, "", "work coordinates 7"),
    g(592, G::kCoordinates, "", "work coordinates 8"),
    g(593, G::kCoordinates, "", "work coordinates 9"),
    g(600, G::kHarmless, "", "save the position"),
    g(610, G::kPathMode, "", "exact path"),
    g(611, G::kPathMode, "", "exact path"),
    g(640, G::kPathMode, "P Q", "blending within P (default tolerance.blend_mm), merging of short lines within Q"),
    g(680, G::kTilt, "X Y Z R", "rotation of the plane by R degrees about the point given, or the current one"),
    g(682, G::kTilt, "X Y Z I J K", "tilted plane: origin, and Euler angles about Z, X, Z"),
    g(690, G::kTilt, "", "end of G68 and G68.2"),
    g(730, G::kMotion, "X Y Z R Q L F", "drilling with chip breaking: after each Q back by 0.25 mm"),
    g(740, G::kMotion, "X Y Z R P L F", "left-hand tapping in a floating holder"),
    g(800, G::kMotion, "", "no motion mode, end of a canned cycle"),
    g(810, G::kMotion, "X Y Z R L F", "drilling: feed to Z, traverse out. R: where feed begins, L: repetitions"),
    g(820, G::kMotion, "X Y Z R P L F", "drilling with a dwell P at Z"),
    g(830, G::kMotion, "X Y Z R Q L F", "drilling in pecks of Q, out to R after each"),
    g(840, G::kMotion, "X Y Z R P L F", "right-hand tapping in a floating holder: feed to Z, spindle reversed, feed out"),
    g(850, G::kMotion, "X Y Z R L F", "boring: feed to Z, feed out"),
    g(860, G::kMotion, "X Y Z R P L F", "boring: feed to Z, dwell P, spindle off, traverse out, spindle on"),
    g(890, G::kMotion, "X Y Z R P L F", "boring: feed to Z, dwell P, feed out"),
    g(900, G::kDistance, "", "absolute distances"),
    g(901, G::kCentre, "", "I J K of arcs are absolute"),
    g(910, G::kDistance, "", "incremental distances, E too"),
    g(911, G::kCentre, "", "I J K of arcs count from their start"),
    g(920, G::kNonmodal, "X Y Z A C E", "offset: the current point gets these coordinates"),
    g(921, G::kNonmodal, "", "clear the G92 offset"),
    g(922, G::kNonmodal, "", "suspend the G92 offset"),
    g(923, G::kNonmodal, "", "restore the G92 offset"),
    g(930, G::kFeedMode, "", "F is the inverse of the move's time in minutes"),
    g(940, G::kFeedMode, "", "F is per minute"),
    g(970, G::kHarmless, "", "constant spindle speed: as always"),
    g(980, G::kRetract, "", "canned cycles go back to where the first of them began"),
    g(990, G::kRetract, "", "canned cycles go back to R"),
};
constexpr std::array kM = {
    m(0, M::kStop, false, "", "pause"),
    m(1, M::kStop, false, "", "pause, when gcode.optional_stop is on"),
    m(2, M::kStop, false, "", "end of the program"),
    m(3, M::kSpindle, false, "S", "spindle clockwise"),
    m(4, M::kSpindle, false, "S", "spindle counterclockwise"),
    m(5, M::kSpindle, false, "", "spindle off"),
    m(6, M::kOther, false, "", "asks for the tool T and waits for the operator"),
    m(7, M::kHarmless, true, "", "coolant mist"),
    m(8, M::kHarmless, true, "", "coolant flood"),
    m(9, M::kOther, false, "", "coolant off: nothing to switch off"),
    m(17, M::kMotors, false, "", "motors on"),
    m(18, M::kMotors, false, "X Y Z A C E S", "motors off (axes); S is noted only"),
    m(19, M::kHarmless, true, "", "spindle orientation"),
    m(20, M::kJobs, false, "", "stored jobs: list"),
    m(21, M::kJobs, false, "", "stored jobs: open the store"),
    m(22, M::kJobs, false, "", "stored jobs: close the store"),
    m(23, M::kJobs, true, "name", "stored jobs: select"),
    m(24, M::kJobs, false, "", "stored jobs: start or go on"),
    m(25, M::kJobs, false, "", "stored jobs: pause; in a job: pause"),
    m(26, M::kJobs, false, "S", "stored jobs: go on from byte S"),
    m(27, M::kJobs, false, "S", "stored jobs: status"),
    m(28, M::kJobs, true, "name", "stored jobs: write"),
    m(29, M::kJobs, true, "", "stored jobs: end of writing"),
    m(30, M::kStop, true, "", "end of the program; with a name: delete a stored job"),
    m(31, M::kJobs, false, "", "stored jobs: status"),
    m(32, M::kJobs, true, "name", "stored jobs: select and start"),
    m(42, M::kOther, false, "P S", "output P at S of 255"),
    m(48, M::kHarmless, true, "", "overrides on"),
    m(49, M::kHarmless, true, "", "overrides off"),
    m(50, M::kHarmless, true, "", "feed override switch"),
    m(51, M::kHarmless, true, "", "speed override switch"),
    m(52, M::kHarmless, true, "", "adaptive feed"),
    m(53, M::kHarmless, true, "", "feed hold switch"),
    m(60, M::kStop, false, "", "pause"),
    m(61, M::kOther, false, "Q", "tool Q is in the spindle"),
    m(62, M::kOther, false, "P", "output P on"),
    m(63, M::kOther, false, "P", "output P off"),
    m(64, M::kOther, false, "P", "output P on"),
    m(65, M::kOther, false, "P", "output P off"),
    m(73, M::kHarmless, true, "", "progress"),
    m(74, M::kHarmless, true, "", "quality of progress"),
    m(75, M::kHarmless, true, "", "print timer"),
    m(76, M::kHarmless, true, "", "print timer"),
    m(77, M::kHarmless, true, "", "print timer"),
    m(78, M::kHarmless, true, "", "print statistics"),
    m(80, M::kHarmless, true, "", "power on"),
    m(81, M::kHarmless, true, "", "power off"),
    m(82, M::kExtrusion, false, "", "E absolute"),
    m(83, M::kExtrusion, false, "", "E relative"),
    m(84, M::kMotors, false, "X Y Z A C E S", "motors off (axes); S is noted only"),
    m(85, M::kHarmless, true, "", "idle time"),
    m(92, M::kHarmless, true, "", "steps for each mm: they belong to the machine file"),
    m(98, M::kOther, false, "P L", "calls the program O P, L times; P\"name\": the macro"),
    m(99, M::kOther, false, "", "returns from a program"),
    m(104, M::kHotend, false, "S T", "temperature of a hot end"),
    m(105, M::kQuery, false, "", "tells the temperatures"),
    m(106, M::kFan, false, "S P", "fan P at S of 255"),
    m(107, M::kFan, false, "P", "fan P off"),
    m(108, M::kHarmless, true, "", "break of a wait"),
    m(109, M::kHotend, false, "S | R T", "temperature of a hot end, and wait"),
    m(110, M::kOther, false, "N", "line number: no effect here"),
    m(111, M::kHarmless, true, "", "debug level"),
    m(112, M::kOther, false, "", "emergency stop"),
    m(113, M::kHarmless, true, "", "keep-alive"),
    m(114, M::kQuery, false, "", "tells the position"),
    m(115, M::kQuery, false, "U", "tells the firmware; U is passed over"),
    m(116, M::kOther, false, "P H C S", "wait for the temperatures set before"),
    m(117, M::kOther, true, "text", "message"),
    m(118, M::kOther, true, "text", "message"),
    m(119, M::kQuery, false, "", "tells the switches"),
    m(120, M::kHarmless, true, "", "state saved"),
    m(121, M::kHarmless, true, "", "state restored"),
    m(122, M::kHarmless, true, "", "driver diagnostics"),
    m(140, M::kBed, false, "S P", "temperature of the bed"),
    m(141, M::kChamber, false, "S P", "temperature of the chamber"),
    m(142, M::kHarmless, true, "", "heat break temperature"),
    m(145, M::kHarmless, true, "", "preheat presets"),
    m(149, M::kHarmless, true, "", "temperature units"),
    m(150, M::kHarmless, true, "", "lights"),
    m(155, M::kHarmless, true, "", "temperature reports"),
    m(190, M::kBed, false, "S | R P", "temperature of the bed, and wait"),
    m(191, M::kChamber, false, "S | R P", "temperature of the chamber, and wait"),
    m(192, M::kHarmless, true, "", "wait for a probe temperature"),
    m(193, M::kHarmless, true, "", "wait for a temperature"),
    m(200, M::kOther, false, "D S T", "volumetric extrusion off (D0); on is refused"),
    m(201, M::kOther, false, "X Y Z A C E", "accelerations of axes, mm/s^2 or deg/s^2"),
    m(203, M::kOther, false, "X Y Z A C E", "speeds of axes, mm/s or deg/s"),
    m(204, M::kOther, false, "P R T S", "accelerations for printing, retraction, travel; S: printing and travel"),
    m(205, M::kOther, false, "X Y Z E J S T B", "jerk: without effect, corners follow G64 P"),
    m(206, M::kHarmless, true, "", "home offsets"),
    m(207, M::kOther, false, "S F Z", "retraction of G10: length, speed, lift"),
    m(208, M::kOther, false, "S F", "recovery of G11: extra length, speed"),
    m(211, M::kHarmless, true, "", "soft end stops"),
    m(217, M::kHarmless, true, "", "filament swap"),
    m(218, M::kHarmless, true, "", "hot end offsets"),
    m(220, M::kOther, false, "S", "feed in percent; B and R store and restore it"),
    m(221, M::kOther, false, "S T", "flow in percent"),
    m(226, M::kStop, true, "", "pause"),
    m(240, M::kHarmless, true, "", "camera"),
    m(250, M::kHarmless, true, "", "display contrast"),
    m(255, M::kHarmless, true, "", "display"),
    m(256, M::kHarmless, true, "", "display brightness"),
    m(260, M::kHarmless, true, "", "I2C"),
    m(261, M::kHarmless, true, "", "I2C"),
    m(280, M::kHarmless, true, "", "servo"),
    m(290, M::kHarmless, true, "", "babystepping"),
    m(300, M::kHarmless, true, "", "sound"),
    m(301, M::kHarmless, true, "", "PID"),
    m(302, M::kHarmless, true, "", "cold extrusion"),
    m(303, M::kHarmless, true, "", "PID tuning"),
    m(304, M::kHarmless, true, "", "PID"),
    m(305, M::kHarmless, true, "", "thermistor"),
    m(306, M::kHarmless, true, "", "heater model"),
    m(307, M::kHarmless, true, "", "heater model"),
    m(350, M::kHarmless, true, "", "microstepping"),
    m(351, M::kHarmless, true, "", "microstepping"),
    m(355, M::kHarmless, true, "", "case light"),
    m(400, M::kOther, false, "", "wait for rest"),
    m(401, M::kHarmless, true, "", "probe down"),
    m(402, M::kHarmless, true, "", "probe up"),
    m(403, M::kHarmless, true, "", "filament type"),
    m(404, M::kHarmless, true, "", "filament width"),
    m(405, M::kHarmless, true, "", "filament width"),
    m(406, M::kHarmless, true, "", "filament width"),
    m(407, M::kHarmless, true, "", "filament width"),
    m(412, M::kHarmless, true, "", "filament sensor"),
    m(413, M::kHarmless, true, "", "power loss recovery"),
    m(415, M::kHarmless, true, "", "power loss recovery"),
    m(420, M::kHarmless, true, "", "bed mesh"),
    m(421, M::kHarmless, true, "", "bed mesh"),
    m(425, M::kHarmless, true, "", "backlash"),
    m(428, M::kHarmless, true, "", "home offsets"),
    m(486, M::kHarmless, true, "", "objects"),
    m(500, M::kSettings, false, "", "settings: store"),
    m(501, M::kSettings, false, "", "settings: load"),
    m(502, M::kSettings, false, "", "settings: machine file's"),
    m(503, M::kSettings, false, "S", "settings: tell"),
    m(540, M::kHarmless, true, "", "stop on end stops"),
    m(550, M::kHarmless, true, "", "machine name"),
    m(551, M::kHarmless, true, "", "password"),
    m(552, M::kHarmless, true, "", "network"),
    m(554, M::kHarmless, true, "", "network"),
    m(555, M::kHarmless, true, "", "printed area"),
    m(556, M::kHarmless, true, "", "axis skew"),
    m(557, M::kHarmless, true, "", "probe grid"),
    m(558, M::kHarmless, true, "", "probe"),
    m(559, M::kHarmless, true, "", "file"),
    m(560, M::kHarmless, true, "", "file"),
    m(561, M::kHarmless, true, "", "bed transform"),
    m(562, M::kHarmless, true, "", "fault"),
    m(563, M::kHarmless, true, "", "tools"),
    m(564, M::kHarmless, true, "", "motion limits"),
    m(565, M::kHarmless, true, "", "probe"),
    m(566, M::kHarmless, true, "", "jerk"),
    m(567, M::kHarmless, true, "", "mixing"),
    m(568, M::kOther, false, "P S R A", "temperature S of tool P"),
    m(569, M::kHarmless, true, "", "driver direction"),
    m(570, M::kHarmless, true, "", "heater fault"),
    m(571, M::kHarmless, true, "", "output on extrusion"),
    m(572, M::kHarmless, true, "", "pressure advance"),
    m(573, M::kHarmless, true, "", "heater"),
    m(574, M::kHarmless, true, "", "end stops"),
    m(575, M::kHarmless, true, "", "serial port"),
    m(577, M::kHarmless, true, "", "trigger"),
    m(578, M::kHarmless, true, "", "inkjet"),
    m(579, M::kHarmless, true, "", "axis scale"),
    m(580, M::kHarmless, true, "", "Roland"),
    m(581, M::kHarmless, true, "", "trigger"),
    m(582, M::kHarmless, true, "", "trigger"),
    m(584, M::kHarmless, true, "", "drivers"),
    m(585, M::kHarmless, true, "", "probe"),
    m(586, M::kHarmless, true, "", "network"),
    m(587, M::kHarmless, true, "", "network"),
    m(589, M::kHarmless, true, "", "network"),
    m(591, M::kHarmless, true, "", "filament monitor"),
    m(592, M::kHarmless, true, "", "nonlinear extrusion"),
    m(593, M::kHarmless, true, "", "input shaping"),
    m(594, M::kHarmless, true, "", "following"),
    m(595, M::kHarmless, true, "", "queue"),
    m(600, M::kStop, true, "", "pause for a change of filament"),
    m(601, M::kStop, true, "", "pause"),
    m(602, M::kHarmless, true, "", "going on after a pause"),
    m(603, M::kHarmless, true, "", "filament change settings"),
    m(605, M::kHarmless, true, "", "dual nozzle mode"),
    m(665, M::kHarmless, true, "", "delta geometry"),
    m(666, M::kHarmless, true, "", "delta geometry"),
    m(669, M::kHarmless, true, "", "kinematics"),
    m(701, M::kHarmless, true, "", "load filament"),
    m(702, M::kHarmless, true, "", "unload filament"),
    m(703, M::kHarmless, true, "", "filament settings"),
    m(704, M::kHarmless, true, "", "load filament"),
    m(705, M::kHarmless, true, "", "eject filament"),
    m(706, M::kHarmless, true, "", "filament"),
    m(707, M::kHarmless, true, "", "filament"),
    m(708, M::kHarmless, true, "", "filament unit"),
    m(709, M::kHarmless, true, "", "filament unit"),
    m(710, M::kHarmless, true, "", "filament unit"),
    m(711, M::kHarmless, true, "", "filament"),
    m(808, M::kHarmless, true, "", "repeat marker"),
    m(810, M::kHarmless, true, "", "stored macro"),
    m(851, M::kHarmless, true, "", "probe offset"),
    m(860, M::kHarmless, true, "", "position encoders"),
    m(862, M::kHarmless, true, "", "printer checks"),
    m(863, M::kHarmless, true, "", "tool mapping"),
    m(871, M::kHarmless, true, "", "probe temperature"),
    m(881, M::kHarmless, true, "", "filament"),
    m(900, M::kHarmless, true, "", "pressure advance"),
    m(906, M::kHarmless, true, "", "motor currents"),
    m(907, M::kHarmless, true, "", "motor currents"),
    m(908, M::kHarmless, true, "", "motor currents"),
    m(909, M::kHarmless, true, "", "drivers"),
    m(911, M::kHarmless, true, "", "drivers"),
    m(912, M::kHarmless, true, "", "drivers"),
    m(913, M::kHarmless, true, "", "drivers"),
    m(914, M::kHarmless, true, "", "stall sensitivity"),
    m(915, M::kHarmless, true, "", "stall sensitivity"),
    m(916, M::kHarmless, true, "", "drivers"),
    m(917, M::kHarmless, true, "", "drivers"),
    m(918, M::kHarmless, true, "", "drivers"),
    m(919, M::kHarmless, true, "", "drivers"),
    m(928, M::kHarmless, true, "", "log"),
    m(950, M::kHarmless, true, "", "devices"),
    m(951, M::kHarmless, true, "", "tools"),
    m(952, M::kHarmless, true, "", "CAN"),
    m(953, M::kHarmless, true, "", "CAN"),
    m(954, M::kHarmless, true, "", "CAN"),
    m(955, M::kHarmless, true, "", "accelerometer"),
    m(956, M::kHarmless, true, "", "accelerometer"),
    m(957, M::kHarmless, true, "", "events"),
    m(970, M::kHarmless, true, "", "drivers"),
    m(997, M::kHarmless, true, "", "firmware update"),
};
// clang-format on

// What Klipper and slicers write as words: it tells or tunes what other machines have, and leaves the job's
// meaning as it is. In lower case, sorted.
constexpr std::array<std::string_view, 35> kHarmlessCommands = {"bed_mesh_calibrate",
                                                                "bed_mesh_clear",
                                                                "bed_mesh_output",
                                                                "bed_mesh_profile",
                                                                "bed_screws_adjust",
                                                                "bed_tilt_calibrate",
                                                                "bltouch_debug",
                                                                "delta_calibrate",
                                                                "exclude_object",
                                                                "exclude_object_define",
                                                                "exclude_object_end",
                                                                "exclude_object_start",
                                                                "probe",
                                                                "probe_calibrate",
                                                                "quad_gantry_level",
                                                                "query_probe",
                                                                "resume",
                                                                "save_config",
                                                                "screws_tilt_calculate",
                                                                "set_display_group",
                                                                "set_display_text",
                                                                "set_fan_speed",
                                                                "set_filament_sensor",
                                                                "set_idle_timeout",
                                                                "set_input_shaper",
                                                                "set_led",
                                                                "set_pin",
                                                                "set_pressure_advance",
                                                                "set_print_stats_info",
                                                                "set_retraction",
                                                                "set_stepper_enable",
                                                                "set_tmc_current",
                                                                "skew_profile",
                                                                "timelapse_take_frame",
                                                                "z_tilt_adjust"};
static_assert(std::is_sorted(kHarmlessCommands.begin(), kHarmlessCommands.end()));

struct Command {
  std::string_view name, words, meaning;
};
constexpr std::array<Command, 8> kCommands = {{
    {"cancel_print", "", "end of the program"},
    {"pause", "", "pause"},
    {"respond", "MSG=", "message"},
    {"set_heater_temperature", "HEATER= TARGET=", "temperature of extruder, extruder1, heater_bed"},
    {"set_velocity_limit", "ACCEL= VELOCITY=", "acceleration of printing and travel; the rest is noted"},
    {"tc", "", "without effect on this machine: filament unit"},
    {"turn_off_heaters", "", "all heaters off"},
    {"tx", "", "without effect on this machine: filament unit"},
}};

struct Reason {
  int code;
  const char* text;
};
constexpr std::array<Reason, 18> kGReasons = {{
    {52, phrase("NURBS (%1) are not supported: use G5 or G1")},
    {53, phrase("NURBS (%1) are not supported: use G5 or G1")},
    {62, phrase("NURBS (%1) are not supported: use G5 or G1")},
    {301, phrase("G30.1 is not supported: use G10 L2 or parameters")},
    {330, phrase("%1 turns with the spindle, which needs an encoder on it")},
    {331, phrase("%1 turns with the spindle, which needs an encoder on it")},
    {410, phrase("cutter compensation (G41) is not supported: offset the path in CAM")},
    {411, phrase("cutter compensation (G41) is not supported: offset the path in CAM")},
    {420, phrase("cutter compensation (G42) is not supported: offset the path in CAM")},
    {421, phrase("cutter compensation (G42) is not supported: offset the path in CAM")},
    {380, phrase("probing (G38) is not supported")},
    {382, phrase("probing (G38.2) is not supported")},
    {683, phrase("G68.3 is not supported: use G68.2 with I J K")},
    {760, phrase("G76 means threading to some and fine boring to others; both need a spindle that follows an "
                 "angle, which this machine does not have")},
    {870, phrase("G87 needs a spindle that stops at an angle, which this machine does not have")},
    {880, phrase("G88 needs an operator who moves the axes by hand: use G82 or G86")},
    {950, phrase("feed for each turn (G95) needs a spindle, which this machine does not have")},
    {960, phrase("constant surface speed (G96) needs a lathe")},
}};
constexpr std::array<Reason, 2> kMReasons = {{
    {3, phrase("M3 turns a spindle, which this machine does not have")},
    {4, phrase("M4 turns a spindle, which this machine does not have")},
}};

template <typename Group, std::size_t size>
constexpr std::array<Group, kCodes> groups_of(const std::array<CodeEntry, size>& entries) {
  std::array<Group, kCodes> groups{};
  for (Group& group : groups) group = Group::kUnknown;
  for (const CodeEntry& entry : entries)
    groups[static_cast<std::size_t>(entry.number)] = static_cast<Group>(entry.group);
  return groups;
}

const CodeEntry* find(std::span<const CodeEntry> entries, int number) {
  const auto at = std::lower_bound(entries.begin(), entries.end(), number,
                                   [](const CodeEntry& entry, int wanted) { return entry.number < wanted; });
  return at != entries.end() && at->number == number ? &*at : nullptr;
}

std::string lower_case(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return small;
}

std::string entry_text(const std::string& name, std::string_view words, std::string_view meaning, bool none) {
  std::string text = name;
  if (!words.empty()) (text += ' ') += words;
  text += ": ";
  if (none) text += "accepted with a note, without effect on this machine: ";
  return text += meaning;
}
std::string text_of_g(const CodeEntry& entry) {
  return entry_text(g_name(entry.number), entry.words, entry.meaning,
                    entry.group == static_cast<std::uint8_t>(GGroup::kHarmless));
}
std::string text_of_m(const CodeEntry& entry) {
  return entry_text(m_name(entry.number), entry.words, entry.meaning,
                    entry.group == static_cast<std::uint8_t>(MGroup::kHarmless));
}

struct Word {
  std::string_view name, text;
};
constexpr std::array<Word, 9> kOWords = {{
    {"sub",
     "oN sub ... oN endsub: a subroutine; #1 to #30 and #<name> are its own, the arguments are #1 ..."},
    {"call", "oN call [1] [2] ...: carries out a subroutine, o<name> call also a macro"},
    {"return", "oN return [value], oN endsub [value]: back to the call; the value is #<_value>"},
    {"if", "oN if [..] ... oN elseif [..] ... oN else ... oN endif"},
    {"while", "oN while [..] ... oN endwhile"},
    {"do", "oN do ... oN while [..]"},
    {"repeat", "oN repeat [times] ... oN endrepeat"},
    {"break", "oN break: leaves the loop oN"},
    {"continue", "oN continue: the next turn of the loop oN"},
}};

}  // namespace

std::span<const CodeEntry> g_codes() {
  return kG;
}
std::span<const CodeEntry> m_codes() {
  return kM;
}
constexpr std::array<GGroup, kCodes> kGGroupOf = groups_of<GGroup>(kG);
constexpr std::array<MGroup, kCodes> kMGroupOf = groups_of<MGroup>(kM);

bool takes_text(int m_number) {
  const CodeEntry* const entry = find(kM, m_number);
  return entry != nullptr && entry->text;
}

bool harmless_command(std::string_view name) {
  return std::binary_search(kHarmlessCommands.begin(), kHarmlessCommands.end(), name) || name == "tx" ||
         name == "tc";
}

std::string g_name(int tenths) {
  std::string name("G");
  name += std::to_string(tenths / 10);
  if (tenths % 10 != 0) (name += '.') += std::to_string(tenths % 10);
  return name;
}

std::string m_name(int number) {
  std::string name("M");
  name += std::to_string(number);
  return name;
}

Sentence unknown_g(int tenths) {
  for (const Reason& reason : kGReasons)
    if (reason.code == tenths) return say(reason.text, g_name(tenths));
  return say("%1 is unknown", g_name(tenths));
}

Sentence unknown_m(int number) {
  for (const Reason& reason : kMReasons)
    if (reason.code == number) return say(reason.text);
  return say("%1 is unknown", m_name(number));
}

std::string reference_entry(std::string_view code) {
  const std::string name = lower_case(code);
  if (name.size() > 1 && (name[0] == 'g' || name[0] == 'm') && name[1] >= '0' && name[1] <= '9') {
    const double number = std::strtod(name.c_str() + 1, nullptr);
    const auto tenths = static_cast<int>(std::lround(std::min(number, 1e6) * 10));
    if (name[0] == 'g') {
      if (const CodeEntry* entry = find(kG, tenths)) return text_of_g(*entry);
      for (const Reason& reason : kGReasons)
        if (reason.code == tenths) return unknown_g(tenths).english();
      return {};
    }
    const CodeEntry* const entry = find(kM, tenths / 10);
    return entry != nullptr ? text_of_m(*entry) : "";
  }
  for (const Command& command : kCommands)
    if (command.name == name) return entry_text(std::string(code), command.words, command.meaning, false);
  if (harmless_command(name)) return entry_text(std::string(code), "", "Klipper's", true);
  for (const Word& word : kOWords)
    if (word.name == name) return std::string(word.text);
  for (const std::string_view predefined : predefined_names())
    if (name == predefined || name == "#<" + std::string(predefined) + ">")
      return "#<" + std::string(predefined) + ">: can only be read; LinuxCNC's";
  return {};
}

std::string reference() {
  std::string all;
  for (const CodeEntry& entry : kG) all += text_of_g(entry) + "\n";
  for (const CodeEntry& entry : kM) all += text_of_m(entry) + "\n";
  for (const Command& command : kCommands)
    all += entry_text(std::string(command.name), command.words, command.meaning, false) + "\n";
  for (const std::string_view name : kHarmlessCommands)
    all += entry_text(std::string(name), "", "Klipper's", true) + "\n";
  for (const Word& word : kOWords) all.append(word.text).append("\n");
  for (const std::string_view name : predefined_names()) all.append("#<").append(name).append(">\n");
  return all;
}

}  // namespace kinebus::gcode
