#include "scenes/io/gltf/gltf_draco_mesh.h"

#include <cstdint>
#include <string>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <fmt/format.h>

#include "scenes/io/gltf/gltf_model.h"
#include "scenes/model/memory.h"

namespace reemit {
namespace {

/// Two numbers at the head of the connectivity, left where they are.
struct Counts {
  std::uint32_t first = 0, second = 0;
  bool read = false;

  explicit Counts(draco::DecoderBuffer ahead) {
    read = draco::DecodeVarint(&first, &ahead) && draco::DecodeVarint(&second, &ahead);
  }
};

Counts faces_and_points(const draco::MeshSequentialDecoder&, const draco::DecoderBuffer& buffer) {
  return Counts(buffer);
}

Counts faces_and_points(const draco::MeshEdgebreakerDecoder&, const draco::DecoderBuffer& buffer) {
  Counts counts(buffer);
  std::swap(counts.first, counts.second);  // Here vertices come first.
  return counts;
}

/// One of Draco's decoders that stops before it asks for more memory than there is.
template <class Decoder>
class Bounded : public Decoder {
 public:
  explicit Bounded(std::size_t promised_faces) : promised_faces_(promised_faces) {}

  /// Why it stopped, or empty.
  const std::string& problem() const { return problem_; }

 protected:
  bool DecodeConnectivity() override {
    const Counts counts = faces_and_points(*this, *this->buffer());
    if (!counts.read) return false;
    if (counts.first != promised_faces_) {
      problem_ = fmt::format("{} triangles, where the accessor of the indices promises {}", counts.first,
                             promised_faces_);
      return false;
    }
    if (counts.second > 3 * promised_faces_) {
      problem_ = fmt::format("{} vertices for {} triangles", counts.second, counts.first);
      return false;
    }
    // Corners, their opposites and vertices, and marks of them.
    constexpr double kBytesPerFace = 100;
    return has_memory(kBytesPerFace * static_cast<double>(counts.first)) && Decoder::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    const draco::PointCloud& points = *this->point_cloud();
    double bytes = 0;
    for (std::int32_t i = 0; i < points.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *points.attribute(i);
      // As coded and as meant, and the index of each value.
      bytes += attribute.num_components() * (draco::DataTypeLength(attribute.data_type()) + 4.0) + 4.0;
    }
    return has_memory(bytes * points.num_points()) && Decoder::DecodeAllAttributes();
  }

 private:
  bool has_memory(double needed) {
    const auto available = available_memory();
    if (!available || needed <= static_cast<double>(*available)) return true;
    problem_ = fmt::format("{:.3g} MB, more than there is memory", needed / 1e6);
    return false;
  }

  std::size_t promised_faces_;
  std::string problem_;
};

template <class Decoder>
std::unique_ptr<draco::Mesh> decode_with(draco::DecoderBuffer& buffer, std::size_t promised_faces,
                                         const JsonCursor& at) {
  Bounded<Decoder> decoder(promised_faces);
  auto mesh = std::make_unique<draco::Mesh>();
  const draco::DecoderOptions options;
  const draco::Status status = decoder.Decode(options, &buffer, mesh.get());
  if (!decoder.problem().empty()) at.fail("the Draco data have " + decoder.problem(), kDamagedAdvice);
  if (!status.ok())
    at.fail(fmt::format("the Draco data cannot be decoded: {}", status.error_msg_string()), kDamagedAdvice);
  return mesh;
}

}  // namespace

std::unique_ptr<draco::Mesh> decode_draco_mesh(const unsigned char* bytes, std::size_t size,
                                               std::size_t promised_faces, const JsonCursor& at) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes), size);
  draco::DracoHeader header;
  {
    draco::DecoderBuffer ahead = buffer;
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok())
      at.fail("the bytes do not begin as Draco data", kDamagedAdvice);
  }
  if (header.version_major != 2 || header.version_minor != 2)
    at.fail(fmt::format("Draco data of the version {}.{}; glTF has 2.2", header.version_major,
                        header.version_minor),
            "Export the file anew.");
  if (header.encoder_type != draco::TRIANGULAR_MESH)
    at.fail("the Draco data are no triangles", kDamagedAdvice);
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
    return decode_with<draco::MeshSequentialDecoder>(buffer, promised_faces, at);
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    return decode_with<draco::MeshEdgebreakerDecoder>(buffer, promised_faces, at);
  at.fail(fmt::format("the Draco data are coded by the method {}, which is not known", header.encoder_method),
          kDamagedAdvice);
}

}  // namespace reemit
