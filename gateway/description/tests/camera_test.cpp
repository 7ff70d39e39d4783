// Addresses of cameras, as machine files have them and as readers get them.

#include <gtest/gtest.h>

#include "gateway/description/camera_address.hpp"

namespace kinebus {
namespace {

TEST(CameraAddress, IsWhatCanStandInAPageAndItsPolicy) {
  for (const char* text : {"http://10.0.0.4/stream", "https://cam.local:8443/?action=stream",
                           "http://[fe80::1]:80/s", "http://[::1]/a/b.mjpg", ":8081/stream", ":1/"})
    EXPECT_TRUE(is_camera_address(text)) << text;
  for (const char* text : {"",
                           "/stream",
                           ":8081",
                           "http://",
                           "http://host",
                           "http:///path",
                           "ftp://host/x",
                           "http://host:99999/x",
                           "http://host:/x",
                           "http://host:8x/x",
                           ":/x",
                           ":70000/x",
                           "http://a b/x",
                           "http://host/x y",
                           "http://host/x;y",
                           "http://host/x,y",
                           "http://host/'x'",
                           "http://host/\"x\"",
                           "http://user@host/x",
                           "http://[::1/x",
                           "http://[]/x",
                           "http://*/x",
                           "javascript:alert(1)/x",
                           "http://host/\n",
                           "http://host/<b>"})
    EXPECT_FALSE(is_camera_address(text)) << text;
  EXPECT_TRUE(is_camera_address("http://host/" + std::string(188, 'a')));
  EXPECT_FALSE(is_camera_address("http://host/" + std::string(189, 'a')));
}

TEST(CameraAddress, OfTheGatewaysComputerIsWhatTheReaderCallsIt) {
  EXPECT_EQ(camera_address_from(":8081/stream", "board.local:5000"), "http://board.local:8081/stream");
  EXPECT_EQ(camera_address_from(":8081/stream", "board"), "http://board:8081/stream");
  EXPECT_EQ(camera_address_from(":8081/stream", "[::1]:5000"), "http://[::1]:8081/stream");
  EXPECT_EQ(camera_address_from(":8081/stream", "[::1]"), "http://[::1]:8081/stream");
  EXPECT_EQ(camera_address_from("https://cam/x", "board:5000"), "https://cam/x");
}

TEST(CameraAddress, HasAnOrigin) {
  EXPECT_EQ(camera_origin("https://cam.local:8443/?x"), "https://cam.local:8443");
  EXPECT_EQ(camera_origin("http://[::1]:1/"), "http://[::1]:1");
}

}  // namespace
}  // namespace kinebus
