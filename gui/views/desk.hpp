#pragma once
// What all views share: the conversation, the models made of it, theme and language. Owned by main.

#include <QString>
#include <QStringList>

#include "gui/link/demo_gateway.hpp"
#include "gui/link/gateway_finder.hpp"
#include "gui/models/axes_model.hpp"
#include "gui/models/events_model.hpp"
#include "gui/models/heat_history.hpp"
#include "gui/models/job_record.hpp"
#include "gui/models/jobs_model.hpp"
#include "gui/models/nodes_model.hpp"
#include "gui/models/path_source.hpp"
#include "gui/models/status_history.hpp"
#include "gui/models/trail.hpp"
#include "gui/models/tuning_curves.hpp"
#include "gui/session/session.hpp"
#include "gui/views/language.hpp"
#include "gui/views/theme.hpp"

namespace kinebus::gui {

struct Desk {
  explicit Desk(const QStringList& more_sockets = {}) : finder(more_sockets) {}

  Session session;
  GatewayFinder finder;
  JobsModel jobs{session};
  EventsModel events{session};
  AxesModel axes{session};
  NodesModel nodes{session};
  StatusHistory history{session};
  HeatHistory heat{session};
  TuningCurves tuning{session};
  JobRecord record{session};
  Trail trail{session};
  PathSource path{session};
  Theme theme;
  Language language;
  std::unique_ptr<DemoGateway> demo;

  void connect_to(const FoundGateway& gateway);
  /// Starts the demo machine and turns to it; `failed` hears why it does not work. `machine_file`: another
  /// machine than a new gateway has.
  void start_demo(const std::function<void(const QString&)>& failed, const QString& machine_file = {});
};

}  // namespace kinebus::gui
