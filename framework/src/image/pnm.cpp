// PBM, PGM, PPM and PAM of Netpbm (P1 to P7). A decoder of our own: stb_image takes every largest sample for 255
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
    bool text = false;   ///< samples are decimal numbers
    bool ink = false;    ///< of one bit, and 1 is black
    std::string tuple{}; ///< what a PAM says that its channels are

    /// Bytes of a row that is not text.
    std::size_t row_bytes() const {
        const auto samples = static_cast<std::size_t>(width * channels);
        return ink ? (samples + 7) / 8 : largest > 255 ? 2 * samples : samples;
    }
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
    /// A digit of a PBM, which needs no white space around it.
    long long digit() {
        skip_space();
        if (at_ == bytes_.size()) fail(file_, "truncated: the file ends inside its numbers");
        const char found = bytes_[at_++];
        if (found != '0' && found != '1') fail(file_, "damaged PNM: 0 or 1 is expected");
        return found - '0';
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
            head.tuple = words.word();
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
        head.ink = kind == '1' || kind == '4';
        head.largest = head.ink ? 1 : words.number();
        head.channels = kind == '3' || kind == '6' ? 3 : 1;
        head.text = kind <= '3';
    }
    check_size(file, head.width, head.height);
    if (head.largest < 1 || head.largest > 65535 || head.channels < 1 || head.channels > 4)
        fail(file, fmt::format("damaged PNM: {} channels of up to {}, expected 1 to 4 of up to 65535",
                               head.channels, head.largest));
    return head;
}

/// One row after another, from text or from bytes, the more significant one first.
class Rows {
public:
    Rows(const Path& file, const Head& head, Words& words)
        : file_(file), head_(head), words_(words), raster_(words.raster()) {
        const auto count = static_cast<std::size_t>(head.width * head.height * head.channels);
        // A number of text needs a digit and what ends it; a bit of text its digit.
        const std::size_t least = !head.text ? head.row_bytes() * static_cast<std::size_t>(head.height)
                                  : head.ink ? count
                                             : 2 * count - 1;
        if (raster_.size() < least) fail(file, "truncated: the file ends inside its pixels");
    }
    void read(float* samples) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(head_.width * head_.channels); ++i) {
            const long long sample = head_.text ? text_sample() : stored_sample(i);
            if (sample > head_.largest)
                fail(file_, fmt::format("damaged PNM: a sample of {}, where {} is the largest", sample,
                                        head_.largest));
            samples[i] = static_cast<float>(head_.ink ? 1 - sample : sample);
        }
        if (!head_.text) raster_.remove_prefix(head_.row_bytes());
    }
    /// Netpbm's files may hold several pictures behind each other.
    bool another_follows() const {
        return !head_.text && raster_.size() > 2 && raster_[0] == 'P' && raster_[1] >= '1'
               && raster_[1] <= '7' && is_space(raster_[2]);
    }

private:
    long long text_sample() { return head_.ink ? words_.digit() : words_.number(); }
    long long stored_sample(std::size_t i) const {
        const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(raster_[at]); };
        if (head_.ink) return byte(i / 8) >> (7 - i % 8) & 1;
        return head_.largest > 255 ? byte(2 * i) << 8 | byte(2 * i + 1) : byte(i);
    }

    const Path& file_;
    const Head& head_;
    Words& words_;
    std::string_view raster_;
};

/// Channels are told apart by their number; other colours than grey and RGB would be taken for those.
void check_tuple(const Path& file, const std::string& tuple) {
    if (tuple.starts_with("CMYK"))
        fail(file,
             fmt::format("a PAM of {}, expected BLACKANDWHITE, GRAYSCALE or RGB, with or without _ALPHA",
                         tuple));
}

StoredPicture stored_pnm(const ImageSource& source) {
    Words words(source.name, source.bytes, 2);
    const Head head = read_head(source.name, source.bytes[1], words);
    check_tuple(source.name, head.tuple);
    Rows rows(source.name, head, words);
    StoredPicture picture;
    picture.samples =
        Image(static_cast<int>(head.width), static_cast<int>(head.height), static_cast<int>(head.channels));
    for (int y = picture.samples.height - 1; y >= 0; --y)
        rows.read(picture.samples.pixel(0, y));
    if (rows.another_follows())
        picture.warnings.emplace_back("it holds several pictures: the first one was taken");
    picture.largest = static_cast<double>(head.largest);
    // Codes of other ranges are none that an 8-bit file could keep.
    picture.coding.bits = head.largest == 255 ? 8 : 16;
    picture.coding.alpha = head.channels % 2 == 0 ? Coding::Alpha::straight : Coding::Alpha::none;
    return picture;
}

bool recognises_pnm(std::string_view bytes) {
    return bytes.size() > 2 && bytes[0] == 'P'
           && std::string_view("1234567").find(bytes[1]) != std::string_view::npos && is_space(bytes[2]);
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
