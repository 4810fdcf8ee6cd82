// PGM, PPM and PAM of Netpbm (P2, P3, P5, P6, P7). A decoder of our own: stb_image takes every largest sample for 255
// and 16 bits in this machine's order.
#include <image/formats.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <charconv>

namespace postfx::formats {
namespace {

bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

struct Head {
    long long width = 0, height = 0, channels = 1, largest = 0;
    bool text = false; ///< samples are decimal numbers
};

/// Words of the header, between white space and comments.
class Words {
public:
    Words(const Path& file, std::string_view bytes, std::size_t at) : file_(file), bytes_(bytes), at_(at) {}

    std::string_view word() {
        skip_space();
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && !is_space(bytes_[at_]))
            ++at_;
        return bytes_.substr(begin, at_ - begin);
    }
    long long number() {
        const std::string_view text = word();
        long long value = -1;
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty()) fail(file_, "truncated: the file ends inside its numbers");
        if (problem != std::errc() || end != text.data() + text.size() || value < 0)
            fail(file_, "damaged PNM: a number is expected");
        return value;
    }
    /// Behind the one white space that ends a header.
    std::string_view raster() const { return bytes_.substr(std::min(bytes_.size(), at_ + 1)); }

private:
    void skip_space() {
        while (at_ < bytes_.size() && (is_space(bytes_[at_]) || bytes_[at_] == '#')) {
            if (bytes_[at_] == '#') at_ = std::min(bytes_.size(), bytes_.find('\n', at_));
            if (at_ < bytes_.size()) ++at_;
        }
    }

    const Path& file_;
    std::string_view bytes_;
    std::size_t at_;
};

Head read_pam_head(const Path& file, Words& words) {
    Head head;
    for (std::string_view name = words.word(); name != "ENDHDR"; name = words.word()) {
        if (name == "WIDTH")
            head.width = words.number();
        else if (name == "HEIGHT")
            head.height = words.number();
        else if (name == "DEPTH")
            head.channels = words.number();
        else if (name == "MAXVAL")
            head.largest = words.number();
        else if (name == "TUPLTYPE")
            words.word();
        else
            fail(file, "truncated or damaged PAM header");
    }
    return head;
}

Head read_head(const Path& file, char kind, Words& words) {
    Head head;
    if (kind == '7') {
        head = read_pam_head(file, words);
    } else {
        head.width = words.number();
        head.height = words.number();
        head.largest = words.number();
        head.channels = kind == '3' || kind == '6' ? 3 : 1;
        head.text = kind == '2' || kind == '3';
    }
    check_size(file, head.width, head.height);
    if (head.largest < 1 || head.largest > 65535 || head.channels < 1 || head.channels > 4)
        fail(file, fmt::format("damaged PNM: {} channels of up to {}, expected 1 to 4 of up to 65535",
                               head.channels, head.largest));
    return head;
}

/// One sample after another, from text or from bytes, the more significant one first.
class Samples {
public:
    Samples(const Path& file, const Head& head, Words& words)
        : file_(file), head_(head), words_(words), raster_(words.raster()),
          size_(head.largest > 255 ? 2 : 1) {
        const auto count = static_cast<std::size_t>(head.width * head.height * head.channels);
        // A number of text needs a digit and what ends it.
        const std::size_t least = head.text ? 2 * count - 1 : size_ * count;
        if (raster_.size() < least) fail(file, "truncated: the file ends inside its pixels");
    }
    float next() {
        long long sample = 0;
        if (head_.text)
            sample = words_.number();
        else
            for (std::size_t i = 0; i < size_; ++i)
                sample = sample << 8 | static_cast<std::uint8_t>(raster_[at_++]);
        if (sample > head_.largest)
            fail(file_,
                 fmt::format("damaged PNM: a sample of {}, where {} is the largest", sample, head_.largest));
        return static_cast<float>(sample);
    }

private:
    const Path& file_;
    const Head& head_;
    Words& words_;
    std::string_view raster_;
    std::size_t size_, at_ = 0;
};

StoredPicture stored_pnm(const ImageSource& source) {
    Words words(source.name, source.bytes, 2);
    const Head head = read_head(source.name, source.bytes[1], words);
    Samples samples(source.name, head, words);
    StoredPicture picture;
    picture.samples =
        Image(static_cast<int>(head.width), static_cast<int>(head.height), static_cast<int>(head.channels));
    for (int y = picture.samples.height - 1; y >= 0; --y)
        for (int i = 0; i < picture.samples.width * picture.samples.channels; ++i)
            picture.samples.pixel(0, y)[i] = samples.next();
    picture.largest = static_cast<double>(head.largest);
    // Codes of other ranges are none that an 8-bit file could keep.
    picture.coding.bits = head.largest == 255 ? 8 : 16;
    picture.coding.alpha = head.channels % 2 == 0 ? Coding::Alpha::straight : Coding::Alpha::none;
    return picture;
}

bool recognises_pnm(std::string_view bytes) {
    return bytes.size() > 2 && bytes[0] == 'P'
           && std::string_view("23567").find(bytes[1]) != std::string_view::npos && is_space(bytes[2]);
}

ImageFile read_pnm(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return as_asked(stored_pnm(source), request);
}

ImageDescription describe_pnm(const ImageSource& source) {
    return described(pnm.name, stored_pnm(source));
}

} // namespace

const Format pnm = {"PNM", recognises_pnm, read_pnm, describe_pnm};

} // namespace postfx::formats
