// Films: frames handed to ffmpeg, which is a program of its own and may be missing.
#pragma once

#include <sys/types.h>

#include <span>
#include <string>

namespace app {

// Whether ffmpeg is found on the path.
bool canWriteVideo();

// A film that is being written, under another name until it is whole. The ending chooses the kind (.mp4, .webm, .mkv).
class VideoWriter {
 public:
  // Throws OutputError where ffmpeg is missing or cannot be started.
  VideoWriter(const std::string& file, int width, int height, double fps);
  ~VideoWriter();  // of a film that was not finished nothing stays
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  // 8-bit RGBA sRGB, top row first, width * height * 4 bytes. Throws OutputError where ffmpeg has given up.
  void add(std::span<const unsigned char> rgba);
  // Waits for ffmpeg and puts the film in place. Throws OutputError.
  void finish();
  // "; of 642x362 pixels, ..." where the frames are of an odd number of rows or columns; else empty.
  std::string sizeNote() const;
  const std::string& file() const { return file_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  std::string file_, unfinished_;
  int width_, height_;
  pid_t process_ = -1;
  int pipe_ = -1, faults_ = -1;  // faults_: what ffmpeg says at its level "error", in memory

  int close();                     // returns ffmpeg's exit status
  std::string faultWords() const;  // its first line; empty: none
  [[noreturn]] void refuse(const char* what) const;
};

}  // namespace app
