#include "tools/assemble/rooms.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "tools/assemble/objective.hpp"
#include "tools/assemble/refill.hpp"

namespace hexpipe {
namespace {

// Changes that gain less are not worth it.
constexpr double least_gain = 0.01;
constexpr int most_passes = 5;

class Rooms {
 public:
  explicit Rooms(GapMesh& gap) : gap_(gap), refill_(gap), changed_(gap.vertex_count(), 0), looked_(gap.vertex_count(), -1) {}

  RoomCounts run() {
    for (pass_ = 0; pass_ < most_passes; ++pass_) {
      const auto before = counts_;
      for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
        if (gap_.is_free(v) && changed_[v] >= pass_ - 1) counts_.vertices += empty_star(v);
      const std::size_t count = gap_.cell_count();
      for (std::size_t c = 0; c < count; ++c) edges_of(static_cast<std::int32_t>(c));
      static const int T=getenv("RT")?atoi(getenv("RT")):0;
      if(T&1) for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
        if (!gap_.is_free(v) && changed_[v] >= pass_ - 1 && gap_.cells_at(v).size()>=3) counts_.fixedv += empty_star(v);
      if(T&2) for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
        if (gap_.is_free(v) && changed_[v] >= pass_ - 1) counts_.grown += grown_star(v);
      if(T&8) for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
        if (gap_.is_free(v) && changed_[v] >= pass_ - 1) counts_.pairs += pairs(v);
      if(T&16) for (std::size_t c = 0; c < count; ++c) counts_.prisms += prism_rooms(static_cast<std::int32_t>(c));
      if(T&32) for (std::size_t c = 0; c < count; ++c) counts_.rings += rings(static_cast<std::int32_t>(c));
      if(T&4) for (std::size_t c = 0; c < count; ++c) counts_.around += around(static_cast<std::int32_t>(c));
      if (counts_.vertices + counts_.edges == before.vertices + before.edges) break;
    }
    if(getenv("VV")) { int h[12][20]={}, nf=0; for (Vertex v=0; v<(Vertex)gap_.vertex_count(); ++v) if(gap_.is_free(v)){++nf;int p=0,t=0; for(auto c:gap_.cells_at(v)) (gap_.cell(c).kind==CellKind::tet?t:p)++; h[std::min(p,11)][std::min(t,19)]++;}
     fprintf(stderr,"free %d\n",nf); for(int i=0;i<9;++i){fprintf(stderr,"pyr %2d:",i);for(int j=0;j<20;++j)fprintf(stderr," %d",h[i][j]);fprintf(stderr,"\n");}
     int fx[5]={},sh[5]={}; for(size_t c=0;c<gap_.cell_count();++c) if(gap_.is_alive(c)&&gap_.cell(c).kind==CellKind::tet){int f=0; for(auto v:gap_.cell(c).vertices()) f+=gap_.is_free(v); fx[f]++; int np=0; for(auto o: neighbours(c)) np+=gap_.cell(o).kind==CellKind::pyramid; sh[np]++;} fprintf(stderr,"tets by free vertices %d %d %d %d %d; by pyramids beside %d %d %d %d %d\n",fx[0],fx[1],fx[2],fx[3],fx[4],sh[0],sh[1],sh[2],sh[3],sh[4]); 
     int pf[2]={},pn[5][5]={}; for(size_t c=0;c<gap_.cell_count();++c) if(gap_.is_alive(c)&&gap_.cell(c).kind==CellKind::pyramid){ pf[gap_.is_free(gap_.cell(c).corners[4])]++; int p=0,t=0; for(auto o: neighbours(c)) (gap_.cell(o).kind==CellKind::tet?t:p)++; pn[p][t]++;} fprintf(stderr,"pyramids apex fixed %d free %d\n",pf[0],pf[1]); for(int p=0;p<5;++p){ for(int t=0;t<5;++t) fprintf(stderr," %d",pn[p][t]); fprintf(stderr,"\n");} }
    return counts_;
  }

 private:
  std::vector<std::int32_t> neighbours(std::int32_t c) {
    std::vector<std::int32_t> r;
    const GapCell& cell=gap_.cell(c);
    for (Vertex v: cell.vertices()) for (auto o: gap_.cells_at(v)) { if(o==c) continue; int n=0; for(Vertex w: gap_.cell(o).vertices()) n+=cell.has(w); if(n>=3) r.push_back(o);}
    std::ranges::sort(r); r.erase(std::unique(r.begin(),r.end()),r.end()); return r;
  }
  bool around(std::int32_t c) {
    if (!gap_.is_alive(c)) return false;
    bool recent=false; for(Vertex v: gap_.cell(c).vertices()) recent|=changed_[v]>=pass_-1; if(!recent) return false;
    room_=neighbours(c); room_.push_back(c);
    return try_room();
  }
  bool rings(std::int32_t c) {
    if (!gap_.is_alive(c)||gap_.cell(c).kind!=CellKind::tet) return false;
    const GapCell cell = gap_.cell(c);
    for (const auto& e : TetTopology::edges) {
        const Vertex a = cell.corners[e[0]], b = cell.corners[e[1]];
        room_.clear(); bool all=true;
        for (const std::int32_t other : gap_.cells_at(a))
          if (gap_.cell(other).has(b)) {room_.push_back(other); all&=gap_.cell(other).kind==CellKind::tet && gap_.cell(other).region==cell.region;}
        if(room_.size()!=4||!all) continue;
        // ring order
        std::vector<std::array<Vertex,2>> st; for(auto o: room_){ std::array<Vertex,2> x{}; int n=0; for(Vertex v: gap_.cell(o).vertices()) if(v!=a&&v!=b) x[n++]=v; 
          Tet t{a,b,x[0],x[1]}; if(tet_determinant(gap_.points(),t)<0) std::swap(x[0],x[1]); st.push_back(x);}
        std::vector<Vertex> ring{st[0][0]}; Vertex at=st[0][1]; bool ok=true;
        while(at!=ring[0]&&ok&&ring.size()<5){ ring.push_back(at); auto f=std::ranges::find_if(st,[&](auto&x){return x[0]==at;}); if(f==st.end()) ok=false; else at=(*f)[1]; }
        if(!ok||ring.size()!=4) continue;
        bool tagged=false; for(Vertex r: ring) tagged|=gap_.is_tagged({a,b,r}); if(tagged) continue;
        double cost=0, worst=least_merged_quality; for(auto o: room_){cost+=cell_cost(gap_.cell(o).quality); worst=std::min(worst,gap_.cell(o).quality);}
        for(int k=0;k<2;++k){ Vertex p=ring[k],q=ring[k+2],u=ring[k+1],w=ring[(k+3)%4];
          // quad a p b q with apexes u and w
          for(int flip=0;flip<2;++flip){
          GapCell one=gap_.make(CellKind::pyramid,flip?std::array<Vertex,6>{a,p,b,q,u}:std::array<Vertex,6>{a,q,b,p,u},cell.region), two=gap_.make(CellKind::pyramid,flip?std::array<Vertex,6>{a,q,b,p,w}:std::array<Vertex,6>{a,p,b,q,w},cell.region);
          double wq=std::min(one.quality,two.quality); static const double RQ=getenv("RQ")?atof(getenv("RQ")):0.12; if(wq<std::max(worst,RQ)) continue;
          if(cell_cost(one.quality)+cell_cost(two.quality)>cost-least_gain) continue;
          for (const std::int32_t r : room_) for (const Vertex v : gap_.cell(r).vertices()) changed_[v] = pass_;
          std::array in{one,two}; gap_.replace(room_, in); return true; } }
    }
    return false;
  }
  bool pairs(Vertex v) {
    const auto a = gap_.cells_at(v); const std::vector<std::int32_t> star(a.begin(),a.end());
    std::vector<std::int32_t> beside;
    for(auto c: star) for(auto o: neighbours(c)) if(std::ranges::find(star,o)==star.end()) beside.push_back(o);
    std::ranges::sort(beside); beside.erase(std::unique(beside.begin(),beside.end()),beside.end());
    for(auto o: beside) for(auto p: neighbours(o)) if(o<p && std::ranges::find(beside,p)!=beside.end()){ room_=star; room_.push_back(o); room_.push_back(p); if(try_room()) return true; }
    return false;
  }
  bool prism_rooms(std::int32_t c) {
    if (!gap_.is_alive(c)||gap_.cell(c).kind!=CellKind::pyramid) return false;
    const GapCell cell=gap_.cell(c);
    for(int i=0;i<4;++i){ Vertex a=cell.corners[i],b=cell.corners[(i+1)%4];
      for(auto o: gap_.cells_at(a)){ if(o<=c) continue; const GapCell other=gap_.cell(o); if(other.kind!=CellKind::pyramid||other.corners[4]==a||other.corners[4]==b||!other.has(b)) continue;
        room_.clear();
        for (const std::int32_t r : gap_.cells_at(a)) if (gap_.cell(r).has(b)) room_.push_back(r);
        for(Vertex x: {cell.corners[4],other.corners[4]}) if(gap_.is_free(x)) for(auto r: gap_.cells_at(x)) room_.push_back(r);
        std::ranges::sort(room_); room_.erase(std::unique(room_.begin(),room_.end()),room_.end());
        if(try_room()) return true;
      } }
    return false;
  }
  bool grown_star(Vertex v) {
    const auto a = gap_.cells_at(v); const std::vector<std::int32_t> star(a.begin(),a.end());
    std::vector<std::int32_t> beside;
    for(auto c: star) for(auto o: neighbours(c)) if(std::ranges::find(star,o)==star.end()) beside.push_back(o);
    std::ranges::sort(beside); beside.erase(std::unique(beside.begin(),beside.end()),beside.end());
    for(auto o: beside) { room_=star; room_.push_back(o); if(try_room()) return true; }
    return false;
  }
  bool empty_star(Vertex v) {
    const auto around = gap_.cells_at(v);
    room_.assign(around.begin(), around.end());
    return try_room();
  }

  void edges_of(std::int32_t c) {
    if (!gap_.is_alive(c)) return;
    const GapCell cell = gap_.cell(c);
    with_topology(cell.kind, [&](auto topology) {
      for (const auto& e : decltype(topology)::edges) {
        const Vertex a = cell.corners[e[0]], b = cell.corners[e[1]];
        if (!gap_.is_alive(c)) return;
        if (changed_[a] < pass_ - 1 && changed_[b] < pass_ - 1) continue;
        room_.clear();
        for (const std::int32_t other : gap_.cells_at(a))
          if (gap_.cell(other).has(b)) room_.push_back(other);
        if (room_.front() != c && std::ranges::min(room_) != c) continue;
        if (room_.size() >= 3) counts_.edges += try_room();
      }
    });
  }

  bool try_room() {
    double cost = 0, worst = least_merged_quality;
    for (const std::int32_t c : room_) {
      cost += cell_cost(gap_.cell(c).quality);
      worst = std::min(worst, gap_.cell(c).quality);
    }
    const auto in = refill_.find(room_, worst, cost - least_gain);
    if (!in) return false;
    for (const std::int32_t c : room_)
      for (const Vertex v : gap_.cell(c).vertices()) changed_[v] = pass_;
    gap_.replace(room_, *in);
    return true;
  }

  GapMesh& gap_;
  Refill refill_;
  int pass_ = 0;
  std::vector<int> changed_, looked_;  // the pass in which cells at a vertex changed
  std::vector<std::int32_t> room_;
  RoomCounts counts_;
};

}  // namespace

RoomCounts refill_rooms(GapMesh& gap) {
  return Rooms(gap).run();
}

}  // namespace hexpipe
