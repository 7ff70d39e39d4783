#pragma once
// Where the pictures of a camera come from: "http://HOST[:PORT]/PATH", the same with https, or ":PORT/PATH"
// on the computer of the gateway.

#include <string>
#include <string_view>

namespace kinebus {

/// At most 200 letters, digits and -._~/?=&%+@ behind the host, which is a name, an IPv4 or an IPv6 address
/// in [].
bool is_camera_address(std::string_view text);

/// `address` for who calls the gateway's computer `host`, with or without a port ("board.local:5000").
std::string camera_address_from(std::string_view address, std::string_view host);

/// "https://host:8443": what comes before the path of an address that camera_address_from() has made.
std::string_view camera_origin(std::string_view address);

}  // namespace kinebus
