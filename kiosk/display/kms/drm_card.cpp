#include "kiosk/display/kms/drm_card.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <type_traits>
#include <utility>

#include <drm_fourcc.h>
#include <fmt/format.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

namespace prismesh::kiosk::display::kms {
namespace {

template <auto Free>
struct FreeWith {
  template <class T>
  void operator()(T* made) const {
    Free(made);
  }
};
template <class T, auto Free>
using DrmData = std::unique_ptr<T, FreeWith<Free>>;

using Resources = DrmData<drmModeRes, drmModeFreeResources>;
using PlaneResources = DrmData<drmModePlaneRes, drmModeFreePlaneResources>;
using ConnectorData = DrmData<drmModeConnector, drmModeFreeConnector>;
using EncoderData = DrmData<drmModeEncoder, drmModeFreeEncoder>;
using PlaneData = DrmData<drmModePlane, drmModeFreePlane>;
using ObjectProperties = DrmData<drmModeObjectProperties, drmModeFreeObjectProperties>;
using PropertyData = DrmData<drmModePropertyRes, drmModeFreeProperty>;
using BlobData = DrmData<drmModePropertyBlobRes, drmModeFreePropertyBlob>;
using Request = DrmData<drmModeAtomicReq, drmModeAtomicFree>;

static_assert(sizeof(drmModeModeInfo) == sizeof(Mode::timings) && std::is_trivially_copyable_v<drmModeModeInfo>);

Mode mode_from(const drmModeModeInfo& info) {
  Mode mode;
  mode.name.assign(info.name, ::strnlen(info.name, sizeof info.name));
  mode.size = {info.hdisplay, info.vdisplay};
  const double pixels = static_cast<double>(info.htotal) * info.vtotal;
  if (pixels > 0) mode.refresh_hz = info.clock * 1000.0 / pixels;
  mode.interlaced = (info.flags & DRM_MODE_FLAG_INTERLACE) != 0;
  if (mode.interlaced) mode.refresh_hz *= 2;
  if ((info.flags & DRM_MODE_FLAG_DBLSCAN) != 0) mode.refresh_hz /= 2;
  mode.preferred = (info.type & DRM_MODE_TYPE_PREFERRED) != 0;
  std::memcpy(mode.timings.data(), &info, sizeof info);
  return mode;
}

Property property_from(const drmModePropertyRes& data, std::uint64_t value) {
  Property property;
  property.id = data.prop_id;
  property.value = value;
  property.fixed = (data.flags & DRM_MODE_PROP_IMMUTABLE) != 0;
  const bool mask = drm_property_type_is(const_cast<drmModePropertyPtr>(&data), DRM_MODE_PROP_BITMASK) != 0;
  for (int i = 0; i < data.count_enums; ++i) {
    const std::uint64_t named = data.enums[i].value;
    property.names.emplace_back(std::string(data.enums[i].name, ::strnlen(data.enums[i].name, sizeof data.enums[i].name)),
                                mask ? std::uint64_t{1} << (named & 63U) : named);
  }
  const bool range = drm_property_type_is(const_cast<drmModePropertyPtr>(&data), DRM_MODE_PROP_RANGE) != 0;
  if (range && data.count_values == 2) {
    property.low = data.values[0];
    property.high = data.values[1];
  }
  return property;
}

class DrmCard final : public Card {
 public:
  DrmCard(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}
  Result<void> open();

  const std::string& name() const override { return name_; }
  Result<CardState> read(bool probe) override;
  int commit(const Change& change) override;
  ObjectId make_blob(std::span<const std::byte> bytes) override;
  void drop_blob(ObjectId blob) override { drmModeDestroyPropertyBlob(descriptor_, blob); }
  std::vector<Flip> take_flips() override;
  int descriptor() const override { return descriptor_; }

 private:
  Properties properties_of(ObjectId object, std::uint32_t kind);
  std::optional<Connector> connector_of(const drmModeRes& resources, ObjectId id, bool probe);
  Plane plane_of(const drmModeRes& resources, const drmModePlane& data);

  int descriptor_;
  std::string name_;
  std::map<ObjectId, PropertyData> known_;  ///< a property's names and range never change
};

Result<void> DrmCard::open() {
  if (drmSetClientCap(descriptor_, DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1) != 0 || drmSetClientCap(descriptor_, DRM_CLIENT_CAP_ATOMIC, 1) != 0)
    return fail(name_, "this graphics card's driver has no atomic mode setting: use the kernel's own driver for it, or an X11 session");
  return {};
}

Properties DrmCard::properties_of(ObjectId object, std::uint32_t kind) {
  Properties all;
  const ObjectProperties values(drmModeObjectGetProperties(descriptor_, object, kind));
  if (!values) return all;
  for (std::uint32_t i = 0; i < values->count_props; ++i) {
    PropertyData& data = known_[values->props[i]];
    if (!data) data.reset(drmModeGetProperty(descriptor_, values->props[i]));
    if (data) all.emplace(data->name, property_from(*data, values->prop_values[i]));
  }
  return all;
}

std::optional<Connector> DrmCard::connector_of(const drmModeRes& resources, ObjectId id, bool probe) {
  const ConnectorData data(probe ? drmModeGetConnector(descriptor_, id) : drmModeGetConnectorCurrent(descriptor_, id));
  if (!data) return std::nullopt;  // it has just been unplugged
  Connector connector;
  connector.id = id;
  const char* kind = drmModeGetConnectorTypeName(data->connector_type);
  connector.name = fmt::format("{}-{}", kind != nullptr ? kind : "Unknown", data->connector_type_id);
  connector.connected = data->connection == DRM_MODE_CONNECTED;
  for (int i = 0; i < data->count_modes; ++i) connector.modes.push_back(mode_from(data->modes[i]));
  for (int i = 0; i < data->count_encoders; ++i) {
    const EncoderData encoder(drmModeGetEncoder(descriptor_, data->encoders[i]));
    if (!encoder) continue;
    for (int at = 0; at < resources.count_crtcs; ++at)
      if ((encoder->possible_crtcs & (1U << static_cast<unsigned>(at))) != 0 &&
          std::find(connector.crtcs.begin(), connector.crtcs.end(), resources.crtcs[at]) == connector.crtcs.end())
        connector.crtcs.push_back(resources.crtcs[at]);
  }
  connector.properties = properties_of(id, DRM_MODE_OBJECT_CONNECTOR);
  const auto edid = connector.properties.find("EDID");
  if (edid != connector.properties.end() && edid->second.value != 0)
    if (const BlobData blob(drmModeGetPropertyBlob(descriptor_, static_cast<ObjectId>(edid->second.value))); blob) {
      const std::span bytes(static_cast<const std::byte*>(blob->data), blob->length);
      connector.edid.assign(bytes.begin(), bytes.end());
    }
  return connector;
}

Plane DrmCard::plane_of(const drmModeRes& resources, const drmModePlane& data) {
  Plane plane;
  plane.id = data.plane_id;
  plane.properties = properties_of(data.plane_id, DRM_MODE_OBJECT_PLANE);
  const auto kind = plane.properties.find("type");
  plane.primary = kind != plane.properties.end() && kind->second.value == DRM_PLANE_TYPE_PRIMARY;
  plane.takes_xrgb8888 =
      std::find(data.formats, data.formats + data.count_formats, std::uint32_t{DRM_FORMAT_XRGB8888}) != data.formats + data.count_formats;
  for (int at = 0; at < resources.count_crtcs; ++at)
    if ((data.possible_crtcs & (1U << static_cast<unsigned>(at))) != 0) plane.crtcs.push_back(resources.crtcs[at]);
  return plane;
}

Result<CardState> DrmCard::read(bool probe) {
  const Resources resources(drmModeGetResources(descriptor_));
  if (!resources) return fail(name_, fmt::format("the graphics card doesn't answer ({})", std::strerror(errno)));
  CardState state;
  for (int i = 0; i < resources->count_connectors; ++i)
    if (std::optional<Connector> connector = connector_of(*resources, resources->connectors[i], probe))
      state.connectors.push_back(std::move(*connector));
  for (int i = 0; i < resources->count_crtcs; ++i)
    state.crtcs.push_back({resources->crtcs[i], properties_of(resources->crtcs[i], DRM_MODE_OBJECT_CRTC)});
  const PlaneResources planes(drmModeGetPlaneResources(descriptor_));
  for (std::uint32_t i = 0; planes && i < planes->count_planes; ++i)
    if (const PlaneData plane(drmModeGetPlane(descriptor_, planes->planes[i])); plane) state.planes.push_back(plane_of(*resources, *plane));
  return state;
}

int DrmCard::commit(const Change& change) {
  const Request request(drmModeAtomicAlloc());
  if (!request) return ENOMEM;
  for (const Setting& setting : change.settings)
    if (drmModeAtomicAddProperty(request.get(), setting.object, setting.property, setting.value) < 0) return ENOMEM;
  std::uint32_t flags = 0;
  if (change.may_set_mode) flags |= DRM_MODE_ATOMIC_ALLOW_MODESET;
  if (change.only_test) flags |= DRM_MODE_ATOMIC_TEST_ONLY;
  if (change.flip_token && !change.only_test) flags |= DRM_MODE_PAGE_FLIP_EVENT | DRM_MODE_ATOMIC_NONBLOCK;
  // The kernel gives this pointer back with the event, and doesn't read what it points to.
  void* token = reinterpret_cast<void*>(static_cast<std::uintptr_t>(change.flip_token.value_or(0)));  // NOLINT(performance-no-int-to-ptr)
  return -drmModeAtomicCommit(descriptor_, request.get(), flags, token);
}

ObjectId DrmCard::make_blob(std::span<const std::byte> bytes) {
  ObjectId blob = 0;
  return drmModeCreatePropertyBlob(descriptor_, bytes.data(), bytes.size(), &blob) == 0 ? blob : 0;
}

// libdrm's drmHandleEvent doesn't say which card an event is of, and waits if there is none.
std::vector<Flip> DrmCard::take_flips() {
  std::vector<Flip> flips;
  alignas(drm_event_vblank) std::array<char, 4096> bytes;
  pollfd watched{descriptor_, POLLIN, 0};
  while (::poll(&watched, 1, 0) > 0 && (watched.revents & POLLIN) != 0) {
    const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
    if (count <= 0) break;
    const std::span got(bytes.data(), static_cast<std::size_t>(count));
    for (std::size_t at = 0; at + sizeof(drm_event) <= got.size();) {
      drm_event head{};
      std::memcpy(&head, &got[at], sizeof head);
      if (head.length < sizeof head || head.length > got.size() - at) break;
      if (drm_event_vblank event{}; head.type == DRM_EVENT_FLIP_COMPLETE && head.length >= sizeof event) {
        std::memcpy(&event, &got[at], sizeof event);
        flips.push_back({event.user_data, event.sequence, (static_cast<std::int64_t>(event.tv_sec) * 1'000'000 + event.tv_usec) * 1000});
      }
      at += head.length;
    }
  }
  return flips;
}

}  // namespace

Result<std::unique_ptr<Card>> make_drm_card(int descriptor, std::string name) {
  auto card = std::make_unique<DrmCard>(descriptor, std::move(name));
  if (Result<void> opened = card->open(); !opened) return fail(opened.error());
  const Result<CardState> state = card->read(false);
  if (!state) return fail(state.error());
  if (state->connectors.empty()) return fail(card->name(), "this graphics card has no monitor sockets");
  return card;
}

}  // namespace prismesh::kiosk::display::kms
