// palpate-gateway: connects a cell's endpoints with the plant's streams. One thread, one poll.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "node/gateway/claims.h"
#include "node/gateway/place/place.h"
#include "node/gateway/plant/plant.h"
#include "node/gateway/plant/streams.h"
#include "node/gateway/upward.h"
#include "node/process/service_manager.h"
#include "palpate/v1/gateway_status.pb.h"

namespace palpate::gateway {

struct GatewayOptions {
  std::string name = "gateway";
  PlantOptions plant;
  StreamLimits streams;
  std::optional<UpwardOptions> up;
  std::vector<PlaceName> places;  ///< those that it may take
  std::size_t most_places = 64;
  FedNodeOptions node;
};

class Gateway {
 public:
  /// Throws std::runtime_error if an endpoint, a folder or a file cannot be opened.
  explicit Gateway(const GatewayOptions& options);

  /// Serves until `stop_fd` is readable. Throws std::runtime_error if the cell's node refuses the
  /// gateway.
  void run(int stop_fd);

 private:
  void serve_plant(SteadyTime now);
  void serve_places(SteadyTime now);
  void tell(SteadyTime now);
  void publish_status();
  void log_changes();
  void send_rest();
  void keep_unsent();

  GatewayOptions options_;
  zmq::context_t context_;
  Plant plant_;
  std::optional<Upward> up_;
  Claims claims_;
  std::map<std::string, std::unique_ptr<Place>, std::less<>> places_;  // by PlaceName::text()
  std::map<std::string, bool, std::less<>> cells_;  // true if the cell's streams exist
  std::uint64_t connection_ = 0;
  bool was_connected_ = false;
  std::string complaint_told_;
  v1::GatewayStatus status_;
  v1::GatewayUpStatus told_;
  std::string disk_error_told_;
  std::string stream_error_told_;
  std::uint64_t dropped_told_ = 0;
  SteadyTime next_word_;
  SteadyTime next_status_;
  ServiceManager service_manager_;
};

}  // namespace palpate::gateway
