#pragma once
// Kinebus's own API: the job link's requests as JSON, by HTTP one by one, or over a websocket that tells
// statuses and events, too. What may be asked follows from kinebus.proto; so does its description.

#include <google/protobuf/descriptor.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gateway/sessions/http/socket.hpp"

namespace kinebus::http {

/// GET /kinebus/v1/socket
std::unique_ptr<Dialect> kinebus_dialect(Socket& socket);

/// Requests that one request of HTTP can make: all but those of a session that lasts, and uploads, whose way
/// is PUT /api/v1/files/local/NAME.
std::vector<const google::protobuf::FieldDescriptor*> plain_requests();
/// Only asks.
bool only_asks(const google::protobuf::FieldDescriptor& request);
/// The description of the API (OpenAPI 3.0), of this version of the gateway.
std::string openapi(const std::string& version);

}  // namespace kinebus::http
