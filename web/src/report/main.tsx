import "../style/report-font.css";
import "../style/tokens.css";
import "../style/controls.css";
import "../style/app.css";
import "../style/explain.css";
import "../style/lecture.css";
import "../style/slides.css";
import "../style/report.css";
import "../style/compare.css";
import "../style/tour.css";
import { render } from "preact";
import { Compare } from "./compare";
import { readReport } from "./data";
import { Explain } from "./explain";
import { Lesson } from "./lesson";
import { Tour } from "./tour";
import type { Report } from "./types";

function Page({ report }: { report: Report }) {
  switch (report.kind) {
    case "explain":
      return <Explain report={report} />;
    case "compare":
      return <Compare report={report} />;
    case "lesson":
      return <Lesson report={report} />;
    case "tour":
      return <Tour report={report} />;
  }
}

const root = document.getElementById("app");
const data = document.getElementById("report");
if (root && data) render(<Page report={readReport(data.textContent ?? "")} />, root);
