#pragma once
// What slicers wrote into stored jobs, as all APIs need it: which picture is meant, and its bytes as an
// answer.

#include <functional>
#include <string>
#include <vector>

#include "gateway/sessions/http/http_session.hpp"

namespace kinebus::http {

/// The smallest one for lists that is more than an icon, else the greatest; nullptr: there is none.
const joblink::SlicerPicture* small_picture(const joblink::SlicerNotes& notes);
const joblink::SlicerPicture* great_picture(const joblink::SlicerNotes& notes);

using ChoosePicture = std::function<const joblink::SlicerPicture*(const joblink::SlicerNotes& notes)>;
/// The picture that `choose` takes, of the first of these jobs that is there; 404: there is none.
void send_picture(Session& session, std::vector<std::string> names, ChoosePicture choose);

/// By the pre-flight where there is one, else as the slicer said; 0: nobody knows.
double estimate_s(const StoredJob& job);

}  // namespace kinebus::http
