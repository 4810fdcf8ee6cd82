// EXR files for tests, written with the library itself: parts, layers and attributes as programs make them.
#pragma once

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace postfx::testing {

using Box = Imath::Box2i;

inline Box box(int x, int y, int width, int height) {
    return Box({x, y}, {x + width - 1, y + height - 1});
}

/// A value that tells channel and place; y counts from the top, as in the file.
inline float value_at(std::size_t channel, int x, int y) {
    return static_cast<float>(channel) * 10000 + static_cast<float>(y) * 100 + static_cast<float>(x);
}

/// Float channels with value_at over the data window.
struct Planes {
    std::vector<std::vector<float>> values;
    Imf::FrameBuffer frame;

    Planes(Imf::Header& header, const std::vector<std::string>& names, std::size_t first_channel = 0) {
        const Box& data = header.dataWindow();
        values.resize(names.size());
        for (std::size_t i = 0; i < names.size(); ++i) {
            for (int y = data.min.y; y <= data.max.y; ++y)
                for (int x = data.min.x; x <= data.max.x; ++x)
                    values[i].push_back(value_at(first_channel + i, x, y));
            header.channels().insert(names[i], Imf::Channel(Imf::FLOAT));
            frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, values[i].data(), data));
        }
    }
};

inline void write_scanlines(const std::filesystem::path& file, Imf::Header header,
                            const std::vector<std::string>& names) {
    const Planes planes(header, names);
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(planes.frame);
    output.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
}

inline Imf::Header header_of(const Box& display, const Box& data) {
    return Imf::Header(display, data);
}

/// One part of a file of several; its channels are counted on from those of the parts before.
struct ExrPart {
    std::string name, view;
    std::vector<std::string> channels;
};

inline void write_parts(const std::filesystem::path& file, const std::vector<ExrPart>& parts,
                        const Box& window = box(0, 0, 2, 2)) {
    std::vector<Imf::Header> headers;
    std::vector<Planes> planes;
    std::size_t channel = 0;
    for (const ExrPart& part : parts) {
        headers.push_back(header_of(window, window));
        headers.back().setName(part.name);
        headers.back().setType(Imf::SCANLINEIMAGE);
        if (!part.view.empty()) headers.back().setView(part.view);
        planes.emplace_back(headers.back(), part.channels, channel);
        channel += part.channels.size();
    }
    Imf::MultiPartOutputFile output(file.c_str(), headers.data(), static_cast<int>(parts.size()));
    for (std::size_t part = 0; part < parts.size(); ++part) {
        Imf::OutputPart out(output, static_cast<int>(part));
        out.setFrameBuffer(planes[part].frame);
        out.writePixels(window.max.y - window.min.y + 1);
    }
}

/// A flat part "rgba" and a part "deep" with one sample, 3, of Z in each pixel.
inline void write_deep_part(const std::filesystem::path& file, const Box& window = box(0, 0, 2, 2)) {
    Imf::Header flat = header_of(window, window), deep = flat;
    flat.setName("rgba");
    flat.setType(Imf::SCANLINEIMAGE);
    const Planes planes(flat, {"R", "G", "B"});
    deep.setName("deep");
    deep.setType(Imf::DEEPSCANLINE);
    deep.compression() = Imf::ZIPS_COMPRESSION;
    deep.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    const auto pixels =
        static_cast<std::size_t>(window.max.x - window.min.x + 1) * (window.max.y - window.min.y + 1);
    std::vector<unsigned> counts(pixels, 1);
    float sample = 3;
    std::vector<float*> samples(pixels, &sample);
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), window));
    const Imf::Slice places = Imf::Slice::Make(Imf::UINT, samples.data(), window, sizeof(float*),
                                               sizeof(float*) * (window.max.x - window.min.x + 1));
    frame.insert("Z", Imf::DeepSlice(Imf::FLOAT, places.base, places.xStride, places.yStride, sizeof sample));
    const Imf::Header headers[2] = {flat, deep};
    Imf::MultiPartOutputFile output(file.c_str(), headers, 2);
    Imf::OutputPart lines(output, 0);
    lines.setFrameBuffer(planes.frame);
    lines.writePixels(window.max.y - window.min.y + 1);
    Imf::DeepScanLineOutputPart deep_lines(output, 1);
    deep_lines.setFrameBuffer(frame);
    deep_lines.writePixels(window.max.y - window.min.y + 1);
}

} // namespace postfx::testing
