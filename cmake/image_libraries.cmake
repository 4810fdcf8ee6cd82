# The C libraries that decode pictures, for postfx_image. They are linked by their paths, so that those who build against
# an exported postfx_image need no find_package() of each.

# postfx_link_decoder(<library> <header> <Debian package>)
function(postfx_link_decoder library header package)
  find_library(POSTFX_LIBRARY_${library} ${library})
  find_path(POSTFX_HEADER_${library} ${header})
  if(NOT POSTFX_LIBRARY_${library} OR NOT POSTFX_HEADER_${library})
    message(FATAL_ERROR "${header} or lib${library} is missing (package ${package})")
  endif()
  target_link_libraries(postfx_image PRIVATE ${POSTFX_LIBRARY_${library}})
  target_include_directories(postfx_image SYSTEM PRIVATE ${POSTFX_HEADER_${library}})
endfunction()

postfx_link_decoder(png png.h libpng-dev)
postfx_link_decoder(z zlib.h zlib1g-dev)
postfx_link_decoder(jpeg jpeglib.h libjpeg62-turbo-dev)
postfx_link_decoder(lcms2 lcms2.h liblcms2-dev)
postfx_link_decoder(tiff tiffio.h libtiff-dev)
postfx_link_decoder(webp webp/decode.h libwebp-dev)
postfx_link_decoder(webpdemux webp/demux.h libwebp-dev)

# Optional: its decoder of HEVC is large, and few need it.
find_library(POSTFX_LIBRARY_heif heif)
find_path(POSTFX_HEADER_heif libheif/heif.h)
if(POSTFX_LIBRARY_heif AND POSTFX_HEADER_heif)
  target_link_libraries(postfx_image PRIVATE ${POSTFX_LIBRARY_heif})
  target_include_directories(postfx_image SYSTEM PRIVATE ${POSTFX_HEADER_heif})
  set(absent heic_absent.cpp)
else()
  message(STATUS "postfx: no HEIC (package libheif-dev)")
  set(absent heic.cpp)
endif()
set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/src/image/${absent} PROPERTIES HEADER_FILE_ONLY ON)
