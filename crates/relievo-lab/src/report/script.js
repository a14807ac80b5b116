
"use strict";
// A click on a picture opens it large, over the truth of its view.
(function () {
  var lens = document.createElement("div");
  lens.id = "lens";
  var stage = document.createElement("div");
  stage.className = "stage";
  var below = document.createElement("img"), above = document.createElement("img");
  var bar = document.createElement("div");
  bar.className = "bar";
  var name = document.createElement("span"), slider = document.createElement("input");
  var hint = document.createElement("span");
  slider.type = "range"; slider.min = 0; slider.max = 1000;
  slider.setAttribute("aria-label", "divider between truth and picture");
  hint.textContent = "left of the divider: truth · space: truth · wheel: zoom · Esc: close";
  bar.append(name, slider, hint);
  stage.append(below, above);
  lens.append(stage, bar);
  document.body.append(lens);
  var width = 1, height = 1, zoom = 1, x = 0, y = 0, drag = null, covered = false;
  function draw() {
    var w = width * zoom, h = height * zoom;
    [below, above].forEach(function (img) {
      img.style.width = w + "px"; img.style.height = h + "px";
      img.style.left = (x - w / 2) + "px"; img.style.top = (y - h / 2) + "px";
    });
    var cut = covered ? 100 : slider.value / 10;
    above.style.clipPath = "inset(0 0 0 " + cut + "%)";
  }
  function close() { lens.classList.remove("on"); }
  document.addEventListener("click", function (event) {
    var img = event.target;
    if (img.tagName !== "IMG") { return; }
    if (lens.contains(img)) { return; }
    var strip = img.closest(".strip");
    if (!strip) { return; }
    below.src = strip.querySelector("img.truth").src;
    above.src = img.src;
    name.textContent = img.title;
    width = img.naturalWidth; height = img.naturalHeight;
    zoom = 0.85 * Math.min(innerWidth / width, (innerHeight - 60) / height);
    x = 0; y = -20; slider.value = 0;
    lens.classList.add("on");
    draw();
  });
  slider.addEventListener("input", draw);
  lens.addEventListener("wheel", function (event) {
    event.preventDefault();
    var factor = Math.exp(-event.deltaY * 0.0015);
    var cx = event.clientX - innerWidth / 2, cy = event.clientY - innerHeight / 2;
    factor = Math.max(0.5, Math.min(64, zoom * factor)) / zoom;
    x = cx + (x - cx) * factor; y = cy + (y - cy) * factor; zoom *= factor;
    draw();
  }, { passive: false });
  lens.addEventListener("pointerdown", function (event) {
    if (bar.contains(event.target)) { return; }
    drag = [event.clientX - x, event.clientY - y, event.clientX, event.clientY];
  });
  lens.addEventListener("pointermove", function (event) {
    if (drag) { x = event.clientX - drag[0]; y = event.clientY - drag[1]; draw(); }
  });
  lens.addEventListener("pointerup", function (event) {
    if (!drag) { return; }
    var moved = Math.hypot(event.clientX - drag[2], event.clientY - drag[3]);
    drag = null;
    if (4 > moved) { close(); }
  });
  document.addEventListener("keydown", function (event) {
    if (!lens.classList.contains("on")) { return; }
    if (event.key === "Escape") { close(); }
    if (event.key === " ") { event.preventDefault(); covered = true; draw(); }
  });
  document.addEventListener("keyup", function (event) {
    if (event.key === " ") { covered = false; draw(); }
  });
})();
