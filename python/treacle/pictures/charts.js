"use strict";
// Curves and phases of a run.

const chartConfig = { responsive: true, displayModeBar: false };
const colours = ["#2563a8", "#d1495b", "#2a9d5c", "#e09f1f", "#7b4fa6", "#3aa6b9", "#8c5a3c", "#5f6b76"];

function drawChart(chart) {
  const section = document.createElement("section"), heading = document.createElement("h2"), place = document.createElement("div");
  heading.textContent = chart.title;
  place.className = "chart";
  section.append(heading, place);
  if (chart.remark) {
    const remark = document.createElement("p");
    remark.className = "quiet";
    remark.textContent = chart.remark;
    section.append(remark);
  }
  element("charts").append(section);
  const traces = chart.curves.map((curve) => ({ ...curve, type: "scatter", mode: curve.x.length === 1 ? "markers" : "lines", line: { width: 1.6 } }));
  const axis = { gridcolor: "#e8ecf0", linecolor: "#b8c2cc", ticks: "outside", tickcolor: "#b8c2cc", zerolinecolor: "#cfd6dd", automargin: true };
  const layout = {
    font, colorway: colours, margin: { l: 56, r: 12, t: 6, b: 44 }, hovermode: "x unified", showlegend: chart.curves.length > 1,
    legend: { orientation: "h", yanchor: "bottom", y: 1.01, x: 0 },
    xaxis: { ...axis, title: { text: chart.x } },
    yaxis: { ...axis, title: { text: chart.y ? `[${chart.y}]` : "" }, exponentformat: "power", type: chart.log ? "log" : "linear" },
  };
  if (!layout.showlegend && chart.curves.length === 1) layout.yaxis.title.text = `${chart.curves[0].name}${chart.y ? ` [${chart.y}]` : ""}`;
  Plotly.newPlot(place, traces, layout, chartConfig);
}

function drawPhases(phases) {
  if (phases.length === 0) {
    element("phases-section").hidden = true;
    return;
  }
  const total = phases.reduce((sum, [, seconds]) => sum + seconds, 0);
  const text = phases.map(([, seconds]) => `${Number(seconds.toPrecision(3))} s (${(100 * seconds / total).toFixed(1)} %)`);
  const bars = { type: "bar", orientation: "h", x: phases.map(([, s]) => s), y: phases.map(([name]) => name), text, textposition: "outside",
    cliponaxis: false, marker: { color: colours[0] }, hoverinfo: "skip" };
  const layout = { font, height: 60 + 30 * phases.length, margin: { l: 90, r: 20, t: 4, b: 40 }, bargap: 0.35,
    xaxis: { title: { text: "[s]" }, range: [0, 1.35 * phases[0][1]], gridcolor: "#e8ecf0" }, yaxis: { autorange: "reversed" } };
  Plotly.newPlot("phases", [bars], layout, chartConfig);
}

run.charts.forEach(drawChart);
drawPhases(run.phases);
