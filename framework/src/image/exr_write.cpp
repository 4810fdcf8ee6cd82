// OpenEXR: a picture alone.
#include <image/exr_file.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>

namespace postfx::formats {

std::string exr_bytes(const Path& file, const Image& image, bool half_floats) {
    static const char* const names[5][4] = {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    return with_exr_errors(file, "no EXR could be made", [&] {
        const Imf::PixelType type = half_floats ? Imf::HALF : Imf::FLOAT;
        const Image rows = upside_down(image);
        std::vector<half> halves;
        if (half_floats) halves.assign(rows.values.begin(), rows.values.end());
        const char* pixels = half_floats ? reinterpret_cast<const char*>(halves.data())
                                         : reinterpret_cast<const char*>(rows.values.data());
        const std::size_t number = half_floats ? sizeof(half) : sizeof(float);
        const auto channels = static_cast<std::size_t>(image.channels);

        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        for (std::size_t channel = 0; channel < channels; ++channel) {
            const char* name = names[channels][channel];
            header.channels().insert(name, Imf::Channel(type));
            frame.insert(name, Imf::Slice::Make(type, pixels + channel * number, header.dataWindow(),
                                                channels * number));
        }
        Imf::StdOSStream stream;
        {
            Imf::OutputFile output(stream, header); // its destructor writes the table of rows
            output.setFrameBuffer(frame);
            output.writePixels(image.height);
        }
        return stream.str();
    });
}

} // namespace postfx::formats
