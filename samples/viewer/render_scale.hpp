// Draws fewer pixels where the device cannot draw all of them in time.
#pragma once

namespace viewer {

class RenderScale {
  public:
    double target = 0; // time of a picture that is aimed at [ms]; 0 = every pixel is drawn
    /// Of the picture's sides: LEAST ... 1.
    float value() const { return value_; }
    static constexpr float LEAST = 0.25f;
    /// What the last picture took [ms]: all of the frame, and the part that follows the pixels.
    void follow(double frame, double pixels);

  private:
    float value_ = 1;
    double frame_ = 0, pixels_ = 0; // means of the newest pictures of this scale
    int counted_ = 0;
};

} // namespace viewer
